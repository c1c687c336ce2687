#include <chrono>
#include <cstdint>
#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>
#include <string>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>
#include <sys/resource.h>

#include "reconstruct/sample/sample_folder.hpp"
#include "reconstruct/section/parameter_text.hpp"
#include "reconstruct/section/section.hpp"
#include "reconstruct/section/section_image.hpp"
#include "reconstruct/section/section_record.hpp"
#include "reconstruct/section/volume_bricks.hpp"
#include "reconstruct/store/durable_file.hpp"
#include "reconstruct/store/volume.hpp"
#include "tools/command.hpp"
#include "tools/command_parameters.hpp"
#include "tools/picture_options.hpp"
#include "tools/section_options.hpp"

namespace biotomy::tools {
namespace {

using reconstruct::SampleFolder;
using reconstruct::Section;
using reconstruct::Vector3;
using reconstruct::Volume;
using reconstruct::VolumeBricks;

struct SectionArguments {
  std::string sample;
  std::string output;
  reconstruct::PlaneText plane;
  SectionOptions options;
  PictureOptions picture;
  bool json = false;
  bool stats = false;
};

constexpr int kSidecarIndentation = 2;

std::int64_t peak_rss_bytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return std::int64_t{usage.ru_maxrss} * 1024;
}

// Reading, decoding and sampling go on in several threads at once: their seconds are the threads'
// added up.
void print_statistics(const Section& section, const Volume& volume, double encode_s) {
  const auto& read = volume.statistics();
  const nlohmann::ordered_json line{
      {"pixels", section.image.total()},
      {"chunks_touched", section.statistics.chunks_touched},
      {"bytes_read", read.bytes_read.load()},
      {"read_s", 1e-9 * static_cast<double>(read.read_ns.load())},
      {"decode_s", 1e-9 * static_cast<double>(read.decode_ns.load())},
      {"sample_s", section.statistics.sample_s},
      {"encode_s", encode_s},
      {"peak_rss_bytes", peak_rss_bytes()},
  };
  std::cerr << line.dump() << '\n';
}

std::filesystem::path sidecar_of(std::filesystem::path picture) {
  return picture.replace_extension(".json");
}

void run_section(const SectionArguments& arguments, const CLI::App& command) {
  reconstruct::picture_format(arguments.output);
  const int quality = jpeg_quality(arguments.picture);
  const SectionChoices chosen = choices(arguments.options);
  const SampleFolder sample = SampleFolder::open(arguments.sample);
  const Volume volume = Volume::open(sample.volume_path());
  const Vector3& spacing = volume.cuboid().spacing;
  const reconstruct::Plane plane =
      reconstruct::parse_plane("--", arguments.plane, chosen.unit, spacing);

  VolumeBricks source(volume, chosen.cache_bytes, chosen.damage);
  const Section section =
      reconstruct::cut_section(source, {plane, reconstruct::section_basis(chosen.basis, plane),
                                        style_for(chosen, arguments.options, spacing)});
  const reconstruct::SectionRecord record{
      sample.description().name, volume.cuboid(), plane, section.outline,
      section.image.size(),      {0, 0},          {0},   command_parameters(command)};
  const auto start = std::chrono::steady_clock::now();
  reconstruct::write_section_image(arguments.output, section.image,
                                   reconstruct::picture_notes(record), quality);
  const std::chrono::duration<double> encoding = std::chrono::steady_clock::now() - start;
  if (arguments.json) {
    reconstruct::write_durably(
        sidecar_of(arguments.output),
        reconstruct::json_text(reconstruct::to_json(record), kSidecarIndentation) + '\n');
  }
  warn_of(source.damage());
  if (arguments.stats) {
    print_statistics(section, volume, encoding.count());
  }
}

}  // namespace

void add_section_command(CLI::App& app) {
  CLI::App* command = app.add_subcommand("section", "Cuts a sample along a plane into a picture");
  auto arguments = std::make_shared<SectionArguments>();
  arguments->options.background = "0,0,0";
  command->add_option("SAMPLE", arguments->sample, "The sample's folder")->required();
  command->add_option("--points", arguments->plane.points,
                      "Three points of the plane, \"x,y,z x,y,z x,y,z\"");
  command->add_option("--normal", arguments->plane.normal,
                      "A normal of the plane, a,b,c: a direction in space, whatever the unit");
  command->add_option("--through", arguments->plane.through, "A point of the plane, x,y,z");
  add_section_options(*command, arguments->options);
  add_picture_options(*command, arguments->picture);
  command->add_flag("--json", arguments->json,
                    "Beside the picture a .json of its name: the plane, the polygon, and the "
                    "matrices from pixels to the sample and back");
  command->add_flag("--stats", arguments->stats, "Print one line of JSON on stderr");
  command->add_option("-o,--output", arguments->output, "The picture: .png, .tif or .jpg")
      ->required();
  command->callback([arguments, command] { run_section(*arguments, *command); });
}

}  // namespace biotomy::tools
