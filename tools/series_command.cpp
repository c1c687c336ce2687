#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <system_error>
#include <utility>

#include <CLI/CLI.hpp>

#include "reconstruct/errors.hpp"
#include "reconstruct/sample/sample_folder.hpp"
#include "reconstruct/section/volume_bricks.hpp"
#include "reconstruct/section/film.hpp"
#include "reconstruct/section/parameter_text.hpp"
#include "reconstruct/section/section_image.hpp"
#include "reconstruct/section/series.hpp"
#include "reconstruct/section/series_frames.hpp"
#include "reconstruct/store/volume.hpp"
#include "tools/command.hpp"
#include "tools/progress_bar.hpp"
#include "tools/section_options.hpp"

namespace biotomy::tools {
namespace {

namespace fs = std::filesystem;

using reconstruct::InvalidRequest;
using reconstruct::SampleError;
using reconstruct::Series;
using reconstruct::Vector3;

/// As they were typed; what was not given is none.
struct SeriesArguments {
  std::string sample;
  std::string axis;
  std::optional<std::string> normal;
  std::optional<std::string> through;
  std::optional<std::string> from;
  std::optional<std::string> to;
  std::string step;
  std::string output;
  std::optional<std::string> movie;
  std::string rate = "25";
  SectionOptions options;
};

Vector3 parse_axis(const std::string& text) {
  if (text == "x") {
    return {1.0, 0.0, 0.0};
  }
  if (text == "y") {
    return {0.0, 1.0, 0.0};
  }
  if (text == "z") {
    return {0.0, 0.0, 1.0};
  }
  if (text.find(',') == std::string::npos) {
    throw InvalidRequest("--axis '" + text + "': give x, y, z or a direction a,b,c");
  }
  return reconstruct::parse_vector("--axis", text);
}

std::optional<Vector3> point(const std::optional<std::string>& text, const SectionChoices& chosen,
                             const Vector3& spacing) {
  if (!text) {
    return std::nullopt;
  }
  return reconstruct::position_in_micrometres(reconstruct::parse_vector("--through", *text),
                                              chosen.unit, spacing);
}

std::optional<double> length(const std::string& name, const std::optional<std::string>& text,
                             const SectionChoices& chosen, const Vector3& spacing) {
  if (!text) {
    return std::nullopt;
  }
  return reconstruct::length_in_micrometres(reconstruct::parse_number(name, *text), chosen.unit,
                                            spacing);
}

Series rotation(const SeriesArguments& arguments, const SectionChoices& chosen,
                const reconstruct::Cuboid& cuboid) {
  reconstruct::Rotation asked;
  asked.axis = parse_axis(arguments.axis);
  asked.through = point(arguments.through, chosen, cuboid.spacing);
  if (arguments.normal) {
    asked.normal = reconstruct::parse_vector("--normal", *arguments.normal);
  }
  asked.from = reconstruct::parse_number("--from", arguments.from.value_or("0"));
  asked.to = reconstruct::parse_number("--to", arguments.to.value_or("180"));
  asked.step = reconstruct::parse_number("--step", arguments.step);
  return reconstruct::rotation_series(asked, chosen.basis, cuboid);
}

Series translation(const SeriesArguments& arguments, const SectionChoices& chosen,
                   const reconstruct::Cuboid& cuboid) {
  reconstruct::Translation asked;
  asked.normal = reconstruct::parse_vector("--normal", arguments.normal.value_or(""));
  asked.through = point(arguments.through, chosen, cuboid.spacing);
  asked.from = length("--from", arguments.from, chosen, cuboid.spacing);
  asked.to = length("--to", arguments.to, chosen, cuboid.spacing);
  asked.step = *length("--step", arguments.step, chosen, cuboid.spacing);
  return reconstruct::translation_series(asked, chosen.basis, cuboid);
}

// Frames of an older series among the new ones would be taken for theirs.
void make_empty_folder(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) {
    throw SampleError(folder.string() + ": the folder can't be made: " + error.message());
  }
  if (!fs::is_empty(folder)) {
    throw SampleError(folder.string() + ": the folder is not empty: name a new one");
  }
}

using MakeSeries = Series (*)(const SeriesArguments&, const SectionChoices&,
                              const reconstruct::Cuboid&);

void run_series(const SeriesArguments& arguments, MakeSeries make_series) {
  const SectionChoices chosen = choices(arguments.options);
  const double rate = reconstruct::parse_number("--rate", arguments.rate);
  if (arguments.movie) {
    reconstruct::check_film_name(*arguments.movie);
  }
  const reconstruct::Volume volume =
      reconstruct::Volume::open(reconstruct::SampleFolder::open(arguments.sample).volume_path());
  reconstruct::VolumeBricks source(volume, chosen.cache_bytes);
  const reconstruct::SeriesFrames frames(
      source, make_series(arguments, chosen, volume.cuboid()),
      style_for(chosen, arguments.options, volume.cuboid().spacing));

  std::optional<reconstruct::Film> film;
  if (arguments.movie) {
    film.emplace(*arguments.movie, rate, frames.frame_size());
  }
  const fs::path folder = arguments.output;
  make_empty_folder(folder);
  ProgressBar progress("Cutting", "frames");
  for (std::size_t i = 0; i < frames.count(); ++i) {
    const cv::Mat frame = frames.draw(i);
    reconstruct::write_section_image(folder / reconstruct::frame_file_name(frames.series(), i),
                                     frame, frames.pixel());
    if (film) {
      film->add(frame);
    }
    progress.update(static_cast<std::int64_t>(i + 1), static_cast<std::int64_t>(frames.count()));
  }
  if (film) {
    film->finish();
  }
}

std::string colour_text(const reconstruct::Colour& colour) {
  return std::to_string(colour[0]) + ',' + std::to_string(colour[1]) + ',' +
         std::to_string(colour[2]);
}

void add_shared_options(CLI::App& command, SeriesArguments& arguments) {
  arguments.options.background = colour_text(reconstruct::kGreyBlue);
  command.add_option("-o,--output", arguments.output, "A new folder for the frames, PNG")
      ->required();
  command.add_option("--movie", arguments.movie, "Also a film of them, .mp4 (H.264)");
  command.add_option("--rate", arguments.rate, "Frames of the film in a second")
      ->capture_default_str();
  add_section_options(command, arguments.options);
}

}  // namespace

void add_series_command(CLI::App& app) {
  CLI::App* command = app.add_subcommand("series", "Cuts a sample along a series of planes");
  auto arguments = std::make_shared<SeriesArguments>();
  command->add_option("SAMPLE", arguments->sample, "The sample's folder")->required();
  command->require_subcommand(1);

  CLI::App* rotate = command->add_subcommand("rotate", "Turns the plane about an axis");
  rotate->add_option("--axis", arguments->axis, "x, y, z or a direction a,b,c")->required();
  rotate->add_option("--through", arguments->through, "A point of the axis, x,y,z; the centre");
  rotate->add_option("--normal", arguments->normal,
                     "Of the plane at 0 degrees, a,b,c; z or the direction nearest to it");
  rotate->add_option("--from", arguments->from, "First angle, degrees; 0");
  rotate->add_option("--to", arguments->to, "Last angle, degrees; 180");
  rotate->add_option("--step", arguments->step, "Degrees between frames")->required();
  add_shared_options(*rotate, *arguments);
  rotate->callback([arguments] { run_series(*arguments, rotation); });

  CLI::App* translate = command->add_subcommand("translate", "Moves the plane along its normal");
  translate->add_option("--normal", arguments->normal, "Of the planes, a,b,c")->required();
  translate->add_option("--through", arguments->through,
                        "A point of the plane at offset 0, x,y,z; 0,0,0");
  translate->add_option("--from", arguments->from, "First offset; where the sample begins");
  translate->add_option("--to", arguments->to, "Last offset; where the sample ends");
  translate->add_option("--step", arguments->step, "Distance between frames")->required();
  add_shared_options(*translate, *arguments);
  translate->callback([arguments] { run_series(*arguments, translation); });
}

}  // namespace biotomy::tools
