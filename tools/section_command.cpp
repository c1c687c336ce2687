#include <chrono>
#include <cstdint>
#include <iostream>
#include <memory>
#include <optional>
#include <string>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>
#include <sys/resource.h>

#include "reconstruct/sample/sample_folder.hpp"
#include "reconstruct/section/volume_bricks.hpp"
#include "reconstruct/section/parameter_text.hpp"
#include "reconstruct/section/section.hpp"
#include "reconstruct/section/section_image.hpp"
#include "reconstruct/store/volume.hpp"
#include "tools/command.hpp"
#include "tools/section_options.hpp"

namespace biotomy::tools {
namespace {

using reconstruct::VolumeBricks;
using reconstruct::SampleFolder;
using reconstruct::Section;
using reconstruct::Vector3;
using reconstruct::Volume;

struct SectionArguments {
  std::string sample;
  std::string output;
  reconstruct::PlaneText plane;
  SectionOptions options;
  bool stats = false;
};

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

void run_section(const SectionArguments& arguments) {
  reconstruct::picture_format(arguments.output);
  const SectionChoices chosen = choices(arguments.options);
  const Volume volume = Volume::open(SampleFolder::open(arguments.sample).volume_path());
  const Vector3& spacing = volume.cuboid().spacing;
  const reconstruct::Plane plane =
      reconstruct::parse_plane("--", arguments.plane, chosen.unit, spacing);

  VolumeBricks source(volume, chosen.cache_bytes);
  const Section section =
      reconstruct::cut_section(source, {plane, reconstruct::section_basis(chosen.basis, plane),
                                        style_for(chosen, arguments.options, spacing)});
  const auto start = std::chrono::steady_clock::now();
  reconstruct::write_section_image(arguments.output, section.image, section.outline.grid.pixel);
  const std::chrono::duration<double> encoding = std::chrono::steady_clock::now() - start;
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
  command->add_flag("--stats", arguments->stats, "Print one line of JSON on stderr");
  command->add_option("-o,--output", arguments->output, "The picture: .png, .tif or .tiff")
      ->required();
  command->callback([arguments] { run_section(*arguments); });
}

}  // namespace biotomy::tools
