#include <cstdint>
#include <iostream>
#include <memory>
#include <string>

#include <CLI/CLI.hpp>

#include "acquisition/records/sample_lock.hpp"
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

/// How the sample's newest layers get into its volume.
std::string remedy(const std::string& sample) {
  const std::string rebuild = "biotomy rebuild " + sample + " puts all layers there";
  return acquisition::SampleLock::is_held(sample)
             ? "what is missing follows when a band is full or the job is done; if it was aborted, "
               "stop biotomyd, and " +
                   rebuild
             : rebuild;
}

/// One line on stderr when an export lacks layers of which there are images. Throws SampleError
/// when there would be no others in it.
void warn_of_layers_left_out(const reconstruct::SampleFolder& sample,
                             const reconstruct::Volume& volume,
                             const reconstruct::ExportRequest& request) {
  const auto left_out = layers_left_out(sample, volume, request);
  if (!left_out) {
    return;
  }
  const std::string folder = sample.path().string();
  const std::string layers = left_out->first == left_out->last
                                 ? "layer " + std::to_string(left_out->first) + " is"
                                 : "layers " + std::to_string(left_out->first) + " to " +
                                       std::to_string(left_out->last) + " are";
  if (volume.layers_present() == 0) {
    throw reconstruct::SampleError(folder + ": has no layers in its volume to export: " + layers +
                                   " there as images alone; " + remedy(folder));
  }
  std::cerr << "biotomy: " << folder << ": " << layers
            << " not in the volume yet, nor in the export; " << remedy(folder) << '\n';
}

void run(const Options& options) {
  if (options.tiff != options.ome_zarr.empty()) {
    throw reconstruct::InvalidRequest("give either --ome-zarr 0.4 or --tiff");
  }
  refuse_output_in_sample("--output", options.output);
  const auto sample = reconstruct::SampleFolder::open(options.sample);
  const auto volume = reconstruct::Volume::of_sample(sample);
  const Interruption interruption;
  reconstruct::ExportRequest request{
      options.output, options.level, options.region, {}, Interruption::requested};
  warn_of_layers_left_out(sample, volume, request);
  ProgressBar bar("Exporting", options.tiff ? "layers" : "chunks");
  request.progress = [&](std::int64_t done, std::int64_t total) { bar.update(done, total); };
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
