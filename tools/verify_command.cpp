#include <cstdint>
#include <filesystem>
#include <iostream>
#include <memory>
#include <string>
#include <system_error>
#include <vector>

#include <CLI/CLI.hpp>

#include "acquisition/records/journal_error.hpp"
#include "acquisition/records/journal_reader.hpp"
#include "reconstruct/errors.hpp"
#include "reconstruct/sample/layer_verification.hpp"
#include "reconstruct/sample/sample_folder.hpp"
#include "reconstruct/store/volume_verification.hpp"
#include "tools/command.hpp"
#include "tools/progress_bar.hpp"

namespace biotomy::tools {
namespace {

namespace fs = std::filesystem;

using reconstruct::Finding;
using reconstruct::LayerHash;
using reconstruct::SampleFolder;
using reconstruct::VerificationListener;

struct Options {
  std::string sample;
  bool deep = false;
};

/// Prints what is found, and counts it.
class Findings {
 public:
  void add(const Finding& finding) {
    std::cout << finding.file.string() << ": " << finding.what << '\n';
    ++count_;
  }
  std::int64_t count() const { return count_; }

  VerificationListener listener(ProgressBar& bar) {
    return {[this](const Finding& finding) { add(finding); },
            [&bar](std::int64_t done, std::int64_t total) { bar.update(done, total); }};
  }

 private:
  std::int64_t count_ = 0;
};

bool is_there(const fs::path& path) {
  std::error_code error;
  return fs::exists(path, error);
}

/// From the journal of the job, or what the import wrote down.
std::vector<LayerHash> records_of(const SampleFolder& sample, Findings& findings) {
  std::vector<LayerHash> records;
  try {
    if (is_there(sample.journal_path())) {
      const acquisition::JournalReader journal(sample.journal_path());
      for (const auto& row : journal.committed_layers(1, sample.description().cuboid.size.z)) {
        records.push_back({row.file, row.sha256});
      }
    } else if (is_there(sample.hashes_path())) {
      records = reconstruct::read_layer_hashes(sample.hashes_path());
    }
  } catch (const acquisition::JournalError& error) {
    findings.add({sample.journal_path(), error.what()});
  } catch (const reconstruct::SampleError& error) {
    findings.add({sample.hashes_path(), error.what()});
  }
  return records;
}

void run(const Options& options) {
  const SampleFolder sample = SampleFolder::open(options.sample);
  Findings findings;
  const std::vector<LayerHash> records = records_of(sample, findings);
  std::int64_t layers = 0;
  std::int64_t shards = 0;
  {
    ProgressBar bar("Verifying layers", "files");
    const bool of_a_job = is_there(sample.journal_path());  // which may not be done yet
    layers = reconstruct::verify_layers(sample, records, !of_a_job, findings.listener(bar));
  }
  {
    ProgressBar bar("Verifying the volume", "shards");
    shards = reconstruct::verify_volume(sample, options.deep, findings.listener(bar));
  }
  std::cout << "verified" << (options.deep ? " voxel for voxel" : "") << ": layer files " << layers
            << ", shards of the volume " << shards << "; "
            << (findings.count() == 0 ? "nothing is wrong"
                                      : "findings " + std::to_string(findings.count()))
            << std::endl;
  if (findings.count() > 0) {
    throw reconstruct::SampleError(options.sample + ": " + std::to_string(findings.count()) +
                                   (findings.count() == 1 ? " thing is" : " things are") +
                                   " wrong with it, see above");
  }
}

}  // namespace

void add_verify_command(CLI::App& app) {
  auto options = std::make_shared<Options>();
  CLI::App* command = app.add_subcommand(
      "verify", "Checks every layer against its hash and every chunk of the volume.");
  command->add_option("SAMPLE", options->sample, "The sample folder")->required();
  command->add_flag("--deep", options->deep,
                    "Also every voxel of the volume against the layers, and every level against "
                    "the one before");
  command->callback([options] { run(*options); });
}

}  // namespace biotomy::tools
