#include <algorithm>
#include <charconv>
#include <cstdint>
#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>
#include <set>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "acquisition/quality/consecutive_frames.hpp"
#include "acquisition/quality/focus_sweep.hpp"
#include "acquisition/quality/noise_judgement.hpp"
#include "acquisition/records/journal_reader.hpp"
#include "acquisition/records/recalled_faces.hpp"
#include "acquisition/service/configuration.hpp"
#include "reconstruct/errors.hpp"
#include "reconstruct/picture/image_file.hpp"
#include "reconstruct/sample/layer_image.hpp"
#include "reconstruct/sample/sample_folder.hpp"
#include "tools/command.hpp"
#include "tools/image_list.hpp"
#include "tools/progress_bar.hpp"
#include "tools/qc_report.hpp"
#include "tools/sweep_report.hpp"

namespace biotomy::tools {
namespace {

namespace fs = std::filesystem;
using acquisition::Assessment;
using acquisition::ConsecutiveFrames;
using acquisition::JournalReader;
using acquisition::QualityThresholds;
using acquisition::Verdict;
using reconstruct::InvalidRequest;
using reconstruct::SampleError;
using reconstruct::SampleFolder;

struct Options {
  std::vector<std::string> images;
  std::string sample;
  std::string layers;
  std::vector<std::string> sweep;
  std::string configuration;
  bool json = false;
  bool strict = false;
};

/// Layers by their section numbers, both ends included.
struct LayerRange {
  std::int64_t first = 1;
  std::int64_t last = 0;
};

/// So many layers before the first one asked for are judged without a word: it is compared with
/// them, as it was when it was taken. None is remembered longer.
constexpr auto kCarriedAlong = static_cast<std::int64_t>(acquisition::FaceRecord::kRemembered);

QualityThresholds thresholds_of(const Options& options) {
  if (options.configuration.empty()) return {};
  return acquisition::read_configuration(options.configuration).job.thresholds;
}

std::optional<std::int64_t> layer_number(const std::string& text) {
  std::int64_t number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc() || end != text.data() + text.size() || number < 1) return std::nullopt;
  return number;
}

/// "A..B", or "A" alone.
LayerRange parse_range(const std::string& text) {
  const std::size_t dots = text.find("..");
  const auto first = layer_number(text.substr(0, dots));
  const auto last = dots == std::string::npos ? first : layer_number(text.substr(dots + 2));
  if (!first || !last || *last < *first) {
    throw InvalidRequest("--layers: \"" + text + "\" is not a range of layers; expected A..B");
  }
  return {*first, *last};
}

void judge_images(const Options& options, const std::vector<fs::path>& files, QcReport& report) {
  ConsecutiveFrames frames(thresholds_of(options));
  ProgressBar bar("Judging", "frames");
  for (std::size_t i = 0; i < files.size(); ++i) {
    cv::Mat image;
    try {
      image = reconstruct::read_image_file(files[i]);
    } catch (const SampleError& error) {
      report.add_unreadable(files[i].string(), std::nullopt, error.what());
      continue;
    }
    const Assessment assessment = frames.judge(image, static_cast<std::int64_t>(i) + 1);
    if (assessment.verdict == Verdict::accepted) frames.accept(assessment, false);
    report.add({files[i].string(), assessment, std::nullopt, {}});
    bar.update(static_cast<std::int64_t>(i) + 1, static_cast<std::int64_t>(files.size()));
  }
}

LayerRange layers_to_judge(const Options& options, const SampleFolder& sample) {
  const std::int64_t present = sample.layers_on_disk(1);
  if (present == 0) throw SampleError(options.sample + ": has no layers yet");
  if (options.layers.empty()) return {1, present};
  const LayerRange asked = parse_range(options.layers);
  if (asked.last > present) {
    throw SampleError(options.sample + ": has layers 1 to " + std::to_string(present) +
                      ", and --layers asks for " + options.layers);
  }
  return asked;
}

/// What a job that starts at this layer recalls of those before. A layer that cannot be read any
/// more recalls nothing.
void recall_before(std::int64_t layer, const SampleFolder& sample, ConsecutiveFrames& frames) {
  if (layer <= 1) return;
  try {
    acquisition::RecalledFaces recalled =
        acquisition::recall_faces(sample, layer - 1, reconstruct::read_layer_image);
    frames.recall(std::move(recalled.faces), std::move(recalled.sharpness),
                  std::move(recalled.surfaces));
  } catch (const SampleError&) {
  }
}

/// What the journal, if there is one, says of the layers' making.
class Past {
 public:
  explicit Past(const SampleFolder& sample) {
    if (!fs::exists(sample.journal_path())) return;
    journal_.emplace(sample.journal_path());
    const std::vector<std::int64_t> starts = journal_->starts();
    starts_.insert(starts.begin(), starts.end());
  }

  bool has_start_at(std::int64_t layer) const { return starts_.contains(layer); }

  /// Nothing of a layer that the journal does not know.
  std::optional<acquisition::LayerRow> layer(std::int64_t number) const {
    if (!journal_) return std::nullopt;
    const auto found = journal_->committed_layers(number, 1);
    if (found.empty() || found.front().layer != number) return std::nullopt;
    return found.front();
  }

  std::vector<acquisition::AttemptNote> attempts(std::int64_t layer) const {
    return journal_ ? journal_->attempts(layer) : std::vector<acquisition::AttemptNote>{};
  }

 private:
  std::optional<JournalReader> journal_;  // an imported sample has none
  std::set<std::int64_t> starts_;
};

/// A sample's layers were accepted, whatever is thought of them now: each is what the next one is
/// compared with, as the daemon did that took them.
void judge_layers(const Options& options, QcReport& report) {
  const SampleFolder sample = SampleFolder::open(options.sample);
  const LayerRange range = layers_to_judge(options, sample);
  const Past past(sample);

  ConsecutiveFrames frames(thresholds_of(options));
  ProgressBar bar("Judging", "layers");
  const std::int64_t first = std::max<std::int64_t>(1, range.first - kCarriedAlong);
  for (std::int64_t layer = first; layer <= range.last; ++layer) {
    if (layer == first || past.has_start_at(layer)) recall_before(layer, sample, frames);
    const fs::path path = sample.layer_path(layer);
    const std::string name = fs::relative(path, sample.path()).string();
    cv::Mat image;
    try {
      image = reconstruct::read_layer_image(path);
    } catch (const SampleError& error) {
      if (layer >= range.first) report.add_unreadable(name, layer, error.what());
      continue;
    }
    const std::optional<acquisition::LayerRow> row = past.layer(layer);
    const bool flagged = row && row->flagged;
    Assessment assessment =
        frames.judge(image, layer, row ? acquisition::noise_noted(row->metrics) : std::nullopt);
    frames.accept(assessment, flagged);
    if (layer < range.first) continue;
    if (flagged && assessment.lacks_only_sharpness) {
      assessment.verdict = Verdict::accepted_with_flag;
    }
    report.add({name, assessment, layer, past.attempts(layer)});
    bar.update(layer - range.first + 1, range.last - range.first + 1);
  }
}

void rank(const Options& options) {
  const std::vector<fs::path> files = list_images(options.sweep);
  if (files.size() < 2) {
    throw InvalidRequest("--sweep needs the frames of at least two focus positions");
  }
  ProgressBar bar("Ranking", "frames");
  std::int64_t read = 0;
  const auto total = static_cast<std::int64_t>(2 * files.size());
  const acquisition::SweepRanking ranking =
      acquisition::rank_sweep(files.size(), [&](std::size_t number) {
        cv::Mat image = reconstruct::read_image_file(files[number]);
        bar.update(++read, total);
        return image;
      });
  if (options.json) {
    print_sweep_json(std::cout, files, ranking);
  } else {
    print_sweep(std::cout, files, ranking);
  }
}

void run(const Options& options) {
  const int asked = static_cast<int>(!options.images.empty()) +
                    static_cast<int>(!options.sample.empty()) +
                    static_cast<int>(!options.sweep.empty());
  if (asked != 1) {
    throw InvalidRequest("give either images or folders, or --sample, or --sweep");
  }
  if (!options.layers.empty() && options.sample.empty()) {
    throw InvalidRequest("--layers goes with --sample");
  }
  if (!options.sweep.empty() && (options.strict || !options.configuration.empty())) {
    throw InvalidRequest(
        "--strict and --config do not go with --sweep, which ranks frames and rejects none");
  }
  if (!options.sweep.empty()) {
    rank(options);
    return;
  }
  // What can't be asked for is said before the report begins.
  const std::vector<fs::path> files = list_images(options.images);
  if (!options.layers.empty()) parse_range(options.layers);
  QcReport report(std::cout, options.json);
  if (options.sample.empty()) {
    judge_images(options, files, report);
  } else {
    judge_layers(options, report);
  }
  report.finish();
  if (report.unreadable() > 0) {
    throw std::runtime_error("images that cannot be read: " + std::to_string(report.unreadable()));
  }
  if (options.strict && report.rejected() > 0) {
    throw std::runtime_error("rejected frames: " + std::to_string(report.rejected()));
  }
}

}  // namespace

void add_qc_command(CLI::App& app) {
  auto options = std::make_shared<Options>();
  CLI::App* command = app.add_subcommand(
      "qc",
      "Judges images as the daemon judges frames: the metrics and the verdict, frame by frame.");
  command->add_option("IMAGES", options->images,
                      "PNG, TIFF or JPEG files and folders of them: consecutive layers in this "
                      "order, a folder's by their names");
  command->add_option("--sample", options->sample,
                      "Judge a sample's stored layers, beside what its journal says of them");
  command->add_option("--layers", options->layers, "Of the sample: A..B, section numbers");
  command
      ->add_option("--sweep", options->sweep,
                   "One field at several focus positions, a folder or files in order: name the "
                   "sharpest frame")
      ->expected(1, -1);
  command
      ->add_option("--config", options->configuration,
                   "The rig.toml whose [quality] limits are used [the defaults]")
      ->check(CLI::ExistingFile);
  command->add_flag("--json", options->json, "As one JSON document");
  command->add_flag("--strict", options->strict, "Exit with 1 when a frame is rejected");
  command->callback([options] { run(*options); });
}

}  // namespace biotomy::tools
