#include <array>
#include <chrono>
#include <cstdint>
#include <ctime>
#include <memory>
#include <string>
#include <vector>

#include "reconstruct/absolute_folder.hpp"
#include "reconstruct/errors.hpp"
#include "reconstruct/import/image_import.hpp"
#include "reconstruct/import/image_sequence.hpp"
#include "reconstruct/store/codecs.hpp"
#include "reconstruct/utf8.hpp"
#include "tools/command.hpp"
#include "tools/freed_memory.hpp"
#include "tools/interruption.hpp"
#include "tools/output_path.hpp"
#include "tools/progress_bar.hpp"

namespace biotomy::tools {
namespace {

constexpr const char* kInterleaved = "interleaved";
constexpr const char* kPlanar = "planar";
constexpr const char* kRefuseGaps = "refuse";
constexpr const char* kRepeatOverGaps = "repeat";
const reconstruct::VolumeLayout kDefaultLayout;

/// The command line says x, y, z; the layout z, y, x.
std::vector<int> xyz_of(const std::array<int, 3>& zyx) {
  return {zyx.rbegin(), zyx.rend()};
}
std::array<int, 3> zyx_of(const std::vector<int>& xyz) {
  return {xyz[2], xyz[1], xyz[0]};
}

struct Options {
  std::vector<std::string> inputs;
  std::vector<double> spacing;
  std::vector<double> size;
  std::string output;
  std::string name;
  std::string notes;
  std::vector<int> chunk = xyz_of(kDefaultLayout.chunk);
  std::vector<int> shard = xyz_of(kDefaultLayout.shard);
  std::string codec = kDefaultLayout.codec;
  std::string colours = kDefaultLayout.interleaved ? kInterleaved : kPlanar;
  std::string compression = "zstd";
  std::string gaps = kRefuseGaps;
  std::int64_t number_step = 1;
  bool restart = false;
};

std::string codec_help() {
  std::string text = "Of the volume's chunks:";
  const char* separator = " ";
  for (const std::string& name : reconstruct::codec_names()) {
    text += separator + name;
    separator = ", ";
  }
  return text;
}

reconstruct::Vector3 vector_of(const std::vector<double>& numbers) {
  return {numbers[0], numbers[1], numbers[2]};
}

std::string now_utc() {
  const std::time_t now = std::chrono::system_clock::to_time_t(std::chrono::system_clock::now());
  std::tm parts{};
  ::gmtime_r(&now, &parts);
  std::array<char, 32> text{};
  std::strftime(text.data(), text.size(), "%Y-%m-%dT%H:%M:%SZ", &parts);
  return text.data();
}

std::string name_of(const Options& options) {
  if (!options.name.empty()) {
    return options.name;
  }
  return reconstruct::utf8_text(reconstruct::absolute_folder(options.output).filename().string());
}

reconstruct::ImportRequest request_of(const Options& options) {
  if (options.spacing.empty() == options.size.empty()) {
    throw reconstruct::InvalidRequest("give either --spacing X,Y,Z or --size X,Y,Z");
  }
  reconstruct::ImportRequest request;
  request.output = options.output;
  request.name = name_of(options);
  request.notes = options.notes;
  request.created = now_utc();
  if (options.spacing.empty()) {
    request.scale = reconstruct::StackSize{vector_of(options.size)};
  } else {
    request.scale = reconstruct::VoxelSpacing{vector_of(options.spacing)};
  }
  request.layer_format.compression = options.compression == "zstd"
                                         ? reconstruct::LayerCompression::zstd
                                         : reconstruct::LayerCompression::deflate;
  request.layout = {zyx_of(options.chunk), zyx_of(options.shard), options.colours == kInterleaved,
                    options.codec};
  request.restart = options.restart;
  reconstruct::check_layout(request.layout);
  return request;
}

void run(const Options& options) {
  const reconstruct::ImportRequest request = request_of(options);
  // Its own name is the import's to judge: there may be an interrupted one to take up.
  refuse_output_in_sample("--output", reconstruct::absolute_folder(options.output).parent_path());
  const auto images =
      reconstruct::ImageSequence::find({options.inputs.begin(), options.inputs.end()},
                                       {options.number_step, options.gaps == kRepeatOverGaps});
  keep_freed_memory();
  const Interruption interruption;
  ProgressBar bar("Importing", "layers");
  import_images(
      images, request, [&](std::int64_t done, std::int64_t total) { bar.update(done, total); },
      Interruption::requested);
}

}  // namespace

void add_import_command(CLI::App& app) {
  auto options = std::make_shared<Options>();
  CLI::App* command = app.add_subcommand(
      "import",
      "Makes a sample of a folder, or of files, of numbered PNG, TIFF or JPEG images, or of the "
      "pages of one TIFF.");
  command
      ->add_option("IMAGES", options->inputs,
                   "One folder, or the files of all layers, or one TIFF whose pages they are")
      ->required();
  CLI::Option* spacing =
      command
          ->add_option("--spacing", options->spacing,
                       "Distances between neighbouring voxels' centres, micrometres: X,Y,Z")
          ->delimiter(',')
          ->expected(3);
  command
      ->add_option("--size", options->size,
                   "Instead: size of the whole stack over its outer sides, micrometres: X,Y,Z")
      ->delimiter(',')
      ->expected(3)
      ->excludes(spacing);
  command->add_option("-o,--output", options->output, "The sample folder to make")->required();
  command->add_option("--name", options->name, "Name of the sample [the folder's]");
  command->add_option("--notes", options->notes, "Anything to be remembered with the sample");
  command
      ->add_option("--layer-compression", options->compression,
                   "Of the layer images: zstd or deflate")
      ->check(CLI::IsMember({"zstd", "deflate"}))
      ->capture_default_str();
  command
      ->add_option("--chunk", options->chunk,
                   "Voxels that are compressed together in the volume: X,Y,Z")
      ->delimiter(',')
      ->expected(3)
      ->capture_default_str();
  command
      ->add_option("--shard", options->shard,
                   "Voxels in one file of the volume, a multiple of the chunk: X,Y,Z")
      ->delimiter(',')
      ->expected(3)
      ->capture_default_str();
  command->add_option("--codec", options->codec, codec_help())->capture_default_str();
  command
      ->add_option("--colours", options->colours,
                   "In the volume's chunks: interleaved, voxel by voxel, or planar")
      ->check(CLI::IsMember({kInterleaved, kPlanar}))
      ->capture_default_str();
  command
      ->add_option("--gaps", options->gaps,
                   "Where numbers are missing: refuse, or repeat the image before the gap")
      ->check(CLI::IsMember({kRefuseGaps, kRepeatOverGaps}))
      ->capture_default_str();
  command
      ->add_option("--number-step", options->number_step,
                   "From a layer's number in the name to the next one's")
      ->check(CLI::Range(std::int64_t{1}, std::int64_t{1'000'000}))
      ->capture_default_str();
  command->add_flag("--restart", options->restart,
                    "Forget what an interrupted import of the same output has done");
  command->callback([options] { run(*options); });
}

}  // namespace biotomy::tools
