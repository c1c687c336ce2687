#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "reconstruct/bricks/opened_sample.hpp"
#include "reconstruct/bricks/volume_bricks.hpp"
#include "reconstruct/errors.hpp"
#include "reconstruct/sample/layer_files_state.hpp"
#include "reconstruct/section/film.hpp"
#include "reconstruct/section/parameter_text.hpp"
#include "reconstruct/section/section_image.hpp"
#include "reconstruct/section/series.hpp"
#include "reconstruct/section/series_folder.hpp"
#include "reconstruct/section/series_frames.hpp"
#include "reconstruct/section/series_parameters.hpp"
#include "tools/command.hpp"
#include "tools/command_parameters.hpp"
#include "tools/interruption.hpp"
#include "tools/output_path.hpp"
#include "tools/picture_options.hpp"
#include "tools/progress_bar.hpp"
#include "tools/section_options.hpp"

namespace biotomy::tools {
namespace {

using reconstruct::InvalidRequest;
using reconstruct::OpenedSample;
using reconstruct::SampleError;
using reconstruct::Series;
using reconstruct::SeriesFrames;

/// As they were typed.
struct SeriesArguments : reconstruct::SeriesParameters {
  std::string sample;
  std::string output;
  std::optional<std::string> movie;
  std::string rate = "25";
  std::string format = "png";
  bool no_label = false;
  bool no_scale_bar = false;
  SectionOptions options;
  PictureOptions picture;
};

using ParseSeries = decltype(&reconstruct::parse_rotation);

std::string extension_of(const SeriesArguments& arguments) {
  constexpr std::array<const char*, 5> kFormats{"png", "tif", "tiff", "jpg", "jpeg"};
  if (std::find(kFormats.begin(), kFormats.end(), arguments.format) == kFormats.end()) {
    throw InvalidRequest("--format '" + arguments.format + "': there are png, tif, jpg");
  }
  return '.' + arguments.format;
}

std::vector<std::string> names_of(const Series& series, const std::string& extension) {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < series.frames.size(); ++i) {
    names.push_back(reconstruct::frame_file_name(series, i, extension));
  }
  return names;
}

/// All that makes the series what it is: two series of the same description have the same frames.
/// A sample that is still being ground is another one with each layer, and so is one of which a
/// layer was replaced.
nlohmann::ordered_json describe(const OpenedSample& sample, const SeriesFrames& frames,
                                const std::vector<std::string>& names,
                                const nlohmann::ordered_json& parameters) {
  const reconstruct::SampleDescription& description = sample.folder.description();
  const auto& [size, spacing] = sample.volume.cuboid();
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (std::size_t i = 0; i < names.size(); ++i) {
    list.push_back({{"value", frames.series().frames[i].value}, {"file", names[i]}});
  }
  return {{"software", "Biotomy " BIOTOMY_VERSION},
          {"sample",
           {{"name", description.name},
            {"created", description.created},
            {"size", {size.x, size.y, size.z}},
            {"spacing_um", {spacing.x, spacing.y, spacing.z}},
            {"bits", sample.volume.bits()},
            {"layers", sample.tail.layers_present()},
            {"layer_files",
             reconstruct::layer_files_state(sample.folder, sample.tail.layers_present())}}},
          {"parameters", parameters},
          {"pixel_um", frames.pixel()},
          {"unit", frames.series().unit},
          {"frames", list}};
}

void run_series(const SeriesArguments& arguments, const CLI::App& command,
                ParseSeries parse_series) {
  const Interruption interruption;
  const SectionChoices chosen = choices(arguments.options);
  const double rate = reconstruct::parse_number("--rate", arguments.rate);
  const std::string extension = extension_of(arguments);
  const int quality = jpeg_quality(arguments.picture);
  refuse_output_in_sample("--output", arguments.output);
  if (arguments.movie) {
    reconstruct::check_film_name(*arguments.movie);
    refuse_output_in_sample("--movie", *arguments.movie);
  }
  const OpenedSample sample(arguments.sample);
  sample.require_layers();
  const reconstruct::Cuboid& cuboid = sample.volume.cuboid();
  reconstruct::VolumeBricks source(sample.volume, chosen.cache_bytes, chosen.damage, &sample.tail);
  const SeriesFrames frames(source,
                            parse_series("--", arguments, chosen.unit, chosen.basis, cuboid),
                            style_for(chosen, arguments.options, cuboid.spacing),
                            {.label = !arguments.no_label, .scale_bar = !arguments.no_scale_bar});
  const nlohmann::ordered_json parameters = command_parameters(command);
  const std::vector<std::string> names = names_of(frames.series(), extension);
  reconstruct::SeriesFolder folder(arguments.output, describe(sample, frames, names, parameters),
                                   names);
  std::optional<reconstruct::Film> film;
  if (arguments.movie) {
    film.emplace(*arguments.movie, rate, frames.frame_size());
  }

  const bool is_jpeg =
      reconstruct::picture_format(names.front()) == reconstruct::PictureFormat::jpeg;
  const int stored_type = is_jpeg ? CV_8UC3 : frames.frame_type();
  ProgressBar progress("Cutting", "frames");
  for (std::size_t i = 0; i < frames.count(); ++i) {
    if (Interruption::requested()) {
      warn_of(source.damage());
      throw SampleError(arguments.output + ": interrupted after " + std::to_string(i) + " of " +
                        std::to_string(frames.count()) +
                        " frames; the same command again takes the series up");
    }
    auto frame = folder.frame(i, frames.frame_size(), stored_type);
    const bool is_there = frame.has_value();
    // What a JPEG has lost would be missing in the film, too: it is the same whether the series was
    // interrupted or not.
    if (!is_there || (film && is_jpeg)) {
      const reconstruct::SampledImage drawn = frames.draw(i);
      frame = drawn.image;
      if (!is_there) {
        // Bricks are kept from frame to frame: once there was damage, any later one may show it.
        folder.store(i, source.damage().chunks > 0, [&](const std::filesystem::path& path) {
          reconstruct::write_section_image(
              path, *frame,
              reconstruct::frame_notes(frames, i, sample.folder.description().name, cuboid,
                                       drawn.statistics, parameters),
              quality);
        });
      }
    }
    if (film) {
      film->add(*frame);
    }
    progress.update(static_cast<std::int64_t>(i + 1), static_cast<std::int64_t>(frames.count()));
  }
  if (film) {
    film->finish();
  }
  warn_of(source.damage());
}

std::string colour_text(const reconstruct::Colour& colour) {
  return std::to_string(colour[0]) + ',' + std::to_string(colour[1]) + ',' +
         std::to_string(colour[2]);
}

void add_shared_options(CLI::App& command, SeriesArguments& arguments) {
  arguments.options.background = colour_text(reconstruct::kGreyBlue);
  command
      .add_option("-o,--output", arguments.output,
                  "A folder for the frames; a new one, or one of this very series to be taken up")
      ->required();
  command.add_option("--format", arguments.format, "Of the frames: png, tif or jpg")
      ->capture_default_str();
  command.add_flag("--no-label", arguments.no_label,
                   "No angle or offset below the pictures, and no room for it");
  command.add_flag("--no-scale-bar", arguments.no_scale_bar,
                   "No scale bar below the pictures; with --no-label nothing but the pictures");
  CLI::Option* movie =
      command.add_option("--movie", arguments.movie, "Also a film of them, .mp4 (H.264)");
  command.add_option("--rate", arguments.rate, "Frames of the film in a second")
      ->needs(movie)
      ->capture_default_str();
  add_section_options(command, arguments.options);
  add_picture_options(command, arguments.picture);
}

}  // namespace

void add_series_command(CLI::App& app) {
  CLI::App* command = app.add_subcommand(
      "series",
      "Cuts a sample along a series of planes. The options of each kind: biotomy series SAMPLE "
      "rotate --help.");
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
  rotate->callback(
      [arguments, rotate] { run_series(*arguments, *rotate, reconstruct::parse_rotation); });

  CLI::App* translate = command->add_subcommand("translate", "Moves the plane along its normal");
  translate->add_option("--normal", arguments->normal, "Of the planes, a,b,c")->required();
  translate->add_option("--through", arguments->through,
                        "A point of the plane at offset 0, x,y,z; 0,0,0");
  translate->add_option("--from", arguments->from, "First offset; where the sample begins");
  translate->add_option("--to", arguments->to, "Last offset; where the sample ends");
  translate->add_option("--step", arguments->step, "Distance between frames")->required();
  add_shared_options(*translate, *arguments);
  translate->callback([arguments, translate] {
    run_series(*arguments, *translate, reconstruct::parse_translation);
  });
}

}  // namespace biotomy::tools
