#include <cstdint>
#include <memory>
#include <string>

#include <CLI/CLI.hpp>

#include "reconstruct/errors.hpp"
#include "reconstruct/export/ome_zarr_04.hpp"
#include "reconstruct/export/tiff_stack.hpp"
#include "reconstruct/sample/sample_folder.hpp"
#include "reconstruct/store/volume.hpp"
#include "tools/command.hpp"
#include "tools/interruption.hpp"
#include "tools/output_path.hpp"
#include "tools/progress_bar.hpp"

namespace biotomy::tools {
namespace {

struct Options {
  std::string sample;
  std::string ome_zarr;
  bool tiff = false;
  int level = 0;
  std::string region;
  std::string output;
};

void run(const Options& options) {
  if (options.tiff != options.ome_zarr.empty()) {
    throw reconstruct::InvalidRequest("give either --ome-zarr 0.4 or --tiff");
  }
  refuse_output_in_sample("--output", options.output);
  const auto sample = reconstruct::SampleFolder::open(options.sample);
  const auto volume = reconstruct::Volume::of_sample(sample);
  const Interruption interruption;
  ProgressBar bar("Exporting", options.tiff ? "layers" : "chunks");
  const reconstruct::ExportRequest request{
      options.output, options.level, options.region,
      [&](std::int64_t done, std::int64_t total) { bar.update(done, total); },
      Interruption::requested};
  if (options.tiff) {
    export_tiff_stack(volume, request);
  } else {
    export_ome_zarr_04(volume, sample.description().name, request);
  }
}

}  // namespace

void add_export_command(CLI::App& app) {
  auto options = std::make_shared<Options>();
  CLI::App* command =
      app.add_subcommand("export", "Writes a sample's volume in a form that older readers take.");
  command->add_option("SAMPLE", options->sample, "The sample folder")->required();
  command->add_option("--ome-zarr", options->ome_zarr, "As OME-Zarr of this version: 0.4 (Zarr v2)")
      ->check(CLI::IsMember({"0.4"}));
  command->add_flag("--tiff", options->tiff, "As numbered TIFFs, one a layer");
  command->add_option("--level", options->level, "The finest level; 0 is full resolution")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  command->add_option("--region", options->region,
                      "Voxels of that level, x0:x1,y0:y1,z0:z1, from 0, the second not included "
                      "[all]");
  command->add_option("-o,--output", options->output, "The folder to make")->required();
  command->callback([options] { run(*options); });
}

}  // namespace biotomy::tools
