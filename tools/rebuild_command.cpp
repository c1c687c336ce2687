#include <cstdint>
#include <memory>
#include <string>

#include <CLI/CLI.hpp>

#include "acquisition/records/sample_lock.hpp"
#include "reconstruct/absolute_folder.hpp"
#include "reconstruct/disk/folder_owner.hpp"
#include "reconstruct/sample/sample_folder.hpp"
#include "reconstruct/store/volume_rebuild.hpp"
#include "tools/command.hpp"
#include "tools/freed_memory.hpp"
#include "tools/interruption.hpp"
#include "tools/progress_bar.hpp"

namespace biotomy::tools {
namespace {

void run(const std::string& folder) {
  const auto sample = reconstruct::SampleFolder::open(folder);
  reconstruct::check_acts_for_owner(sample.path());  // before it makes a lock file, too
  const acquisition::SampleLock lock(reconstruct::absolute_folder(folder));
  keep_freed_memory();
  const Interruption interruption;
  ProgressBar bar("Rebuilding", "layers");
  reconstruct::rebuild_volume(
      sample, [&](std::int64_t done, std::int64_t total) { bar.update(done, total); },
      Interruption::requested);
}

}  // namespace

void add_rebuild_command(CLI::App& app) {
  auto sample = std::make_shared<std::string>();
  CLI::App* command = app.add_subcommand(
      "rebuild", "Makes a sample's volume anew from its layers; the old one stays until then.");
  command->add_option("SAMPLE", *sample, "The sample folder")->required();
  command->callback([sample] { run(*sample); });
}

}  // namespace biotomy::tools
