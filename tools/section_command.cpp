#include <algorithm>
#include <chrono>
#include <cstdint>
#include <filesystem>
#include <iostream>
#include <memory>
#include <string>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>
#include <opencv2/core/mat.hpp>
#include <sys/resource.h>

#include "reconstruct/bricks/opened_sample.hpp"
#include "reconstruct/bricks/volume_bricks.hpp"
#include "reconstruct/disk/durable_file.hpp"
#include "reconstruct/errors.hpp"
#include "reconstruct/interruption.hpp"
#include "reconstruct/section/cache_need.hpp"
#include "reconstruct/section/frame_canvas.hpp"
#include "reconstruct/section/parameter_text.hpp"
#include "reconstruct/section/sampler.hpp"
#include "reconstruct/section/scale_bar.hpp"
#include "reconstruct/section/section.hpp"
#include "reconstruct/section/section_image.hpp"
#include "reconstruct/section/section_record.hpp"
#include "reconstruct/store/volume.hpp"
#include "tools/command.hpp"
#include "tools/command_parameters.hpp"
#include "tools/interruption.hpp"
#include "tools/output_path.hpp"
#include "tools/picture_options.hpp"
#include "tools/plane_options.hpp"
#include "tools/progress_bar.hpp"
#include "tools/section_options.hpp"

namespace biotomy::tools {
namespace {

using Clock = std::chrono::steady_clock;
using reconstruct::OpenedSample;
using reconstruct::PixelGrid;
using reconstruct::SampleError;
using reconstruct::SampleStatistics;
using reconstruct::SectionStyle;
using reconstruct::Volume;
using reconstruct::VolumeBricks;

struct SectionArguments {
  std::string sample;
  std::string output;
  PlaneOptions plane;
  SectionOptions options;
  PictureOptions picture;
  bool scale_bar = false;
  bool json = false;
  bool stats = false;
};

constexpr int kSidecarIndentation = 2;

std::int64_t peak_rss_bytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return std::int64_t{usage.ru_maxrss} * 1024;
}

struct Durations {
  std::chrono::duration<double> section{0.0};  // from opening the sample to the picture in memory
  std::chrono::duration<double> encode{0.0};
};

// Reading, decoding and sampling go on in several threads at once: their seconds are the threads'
// added up.
void print_statistics(const PixelGrid& grid, const SampleStatistics& sampled, const Volume& volume,
                      const Durations& durations) {
  const auto& read = volume.statistics();
  const nlohmann::ordered_json line{
      {"pixels", std::int64_t{grid.columns} * grid.rows},
      {"chunks_touched", sampled.chunks_touched},
      {"bytes_read", read.bytes_read.load()},
      {"read_s", 1e-9 * static_cast<double>(read.read_ns.load())},
      {"decode_s", 1e-9 * static_cast<double>(read.decode_ns.load())},
      {"sample_s", sampled.sample_s},
      {"section_s", durations.section.count()},
      {"encode_s", durations.encode.count()},
      {"peak_rss_bytes", peak_rss_bytes()},
  };
  std::cerr << line.dump() << '\n';
}

std::filesystem::path sidecar_of(std::filesystem::path picture) {
  return picture.replace_extension(".json");
}

struct Picture {
  cv::Mat image;
  cv::Point first;  // pixel of the section
};

/// Of the section's size; with a scale bar larger by the strip below that the bar is in.
Picture empty_picture(const PixelGrid& grid, int bits, const SectionStyle& style, bool scale_bar) {
  const int type = bits == 16 ? CV_16UC3 : CV_8UC3;
  const cv::Size size(grid.columns, grid.rows);
  if (!scale_bar) {
    return {cv::Mat(size, type), {0, 0}};
  }
  const reconstruct::FrameCanvas canvas(size, "", style.background,
                                        reconstruct::scale_bar(size.width, grid.pixel));
  if (canvas.bytes(type) > static_cast<double>(style.max_bytes)) {
    throw SampleError(
        "the picture with its scale bar is too large for memory: ask for a larger pixel, or leave "
        "out --scale-bar");
  }
  return {canvas.draw_empty(type, ""), canvas.place_of(size)};
}

/// Draws the section into the picture. The chunks are gone when it returns: encoding the picture
/// needs the memory.
SampleStatistics cut(const OpenedSample& sample, const PixelGrid& grid, const SectionStyle& style,
                     const SectionChoices& chosen, const std::string& output, Picture& picture) {
  const Volume& volume = sample.volume;
  VolumeBricks source(
      volume,
      std::min(chosen.cache_bytes, reconstruct::cache_for_one_section(grid.columns, volume.bits())),
      chosen.damage, &sample.tail);
  ProgressBar progress("Cutting", "rows");
  cv::Mat part = picture.image({picture.first, cv::Size(grid.columns, grid.rows)});
  SampleStatistics statistics = reconstruct::sample_grid(
      source, grid, style.interpolation, style.background, part,
      [&](std::int64_t done, std::int64_t total) {
        reconstruct::stop_here_if(&Interruption::requested,
                                  output + ": interrupted; the picture was not written");
        progress.update(done, total);
      });
  warn_of(source.damage());
  return statistics;
}

void run_section(const SectionArguments& arguments, const CLI::App& command) {
  const Interruption interruption;
  reconstruct::picture_format(arguments.output);
  refuse_output_in_sample("--output", arguments.output);
  if (arguments.json) {
    refuse_output_in_sample("--json", sidecar_of(arguments.output));
  }
  const int quality = jpeg_quality(arguments.picture);
  const SectionChoices chosen = choices(arguments.options);
  Durations durations;
  auto start = Clock::now();
  const OpenedSample sample(arguments.sample);
  sample.require_layers();
  const reconstruct::Cuboid& cuboid = sample.volume.cuboid();
  const reconstruct::Plane plane = plane_of(arguments.plane, chosen.unit, cuboid);
  const SectionStyle style = style_for(chosen, arguments.options, cuboid.spacing);
  const reconstruct::SectionOutline outline =
      reconstruct::outline_section(cuboid, sample.volume.bits(),
                                   {plane, reconstruct::section_basis(chosen.basis, plane), style});
  Picture picture = empty_picture(outline.grid, sample.volume.bits(), style, arguments.scale_bar);
  const SampleStatistics statistics =
      cut(sample, outline.grid, style, chosen, arguments.output, picture);
  durations.section = Clock::now() - start;
  start = Clock::now();
  const reconstruct::SectionRecord record{sample.folder.description().name,
                                          cuboid,
                                          plane,
                                          outline,
                                          picture.image.size(),
                                          picture.first,
                                          statistics.levels,
                                          command_parameters(command)};
  reconstruct::write_section_image(arguments.output, picture.image,
                                   reconstruct::picture_notes(record), quality);
  durations.encode = Clock::now() - start;
  if (arguments.json) {
    reconstruct::write_durably(
        sidecar_of(arguments.output),
        reconstruct::json_text(reconstruct::to_json(record), kSidecarIndentation) + '\n');
  }
  if (arguments.stats) {
    print_statistics(outline.grid, statistics, sample.volume, durations);
  }
}

}  // namespace

void add_section_command(CLI::App& app) {
  CLI::App* command = app.add_subcommand("section", "Cuts a sample along a plane into a picture.");
  auto arguments = std::make_shared<SectionArguments>();
  arguments->options.background = "0,0,0";
  command->add_option("SAMPLE", arguments->sample, "The sample's folder")->required();
  add_plane_options(*command, arguments->plane);
  add_section_options(*command, arguments->options);
  add_picture_options(*command, arguments->picture);
  command->add_flag("--scale-bar", arguments->scale_bar,
                    "A scale bar in a strip below the section, as a series has it");
  command->add_flag("--json", arguments->json,
                    "Beside the picture a .json of its name: the plane, the polygon, and the "
                    "matrices from pixels to the sample and back");
  command->add_flag("--stats", arguments->stats, "Print one line of JSON on stderr");
  command->add_option("-o,--output", arguments->output, "The picture: .png, .tif or .jpg")
      ->required();
  command->callback([arguments, command] {
    take_unquoted_points(*command);
    run_section(*arguments, *command);
  });
}

}  // namespace biotomy::tools
