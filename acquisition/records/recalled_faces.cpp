#include "acquisition/records/recalled_faces.hpp"

#include <algorithm>
#include <memory>

#include "acquisition/quality/face_judgement.hpp"
#include "acquisition/quality/light_judgement.hpp"
#include "acquisition/quality/noise_judgement.hpp"
#include "acquisition/records/journal_reader.hpp"

namespace biotomy::acquisition {
namespace {

/// The casting material's colour as a layer shows it.
std::optional<CastingColour> casting_of(const LayerRow& layer) {
  CastingColour casting;
  std::size_t known = 0;
  for (const Metric& metric : layer.metrics) {
    for (std::size_t c = 0; c < kCastingMetrics.size(); ++c) {
      if (metric.name != kCastingMetrics.at(c)) continue;
      casting.level[static_cast<int>(c)] = metric.value;
      ++known;
    }
  }
  if (known == kCastingMetrics.size()) return casting;
  return std::nullopt;
}

/// In the first layer that shows it, which is among the first in most samples.
std::optional<CastingColour> first_casting(const JournalReader& journal, std::int64_t last) {
  constexpr std::int64_t kAtATime = 16;
  for (std::int64_t first = 1; first <= last; first += kAtATime) {
    const std::int64_t layers = std::min(kAtATime, last - first + 1);
    for (const LayerRow& layer : journal.committed_layers(first, layers)) {
      if (auto casting = casting_of(layer)) return casting;
    }
  }
  return std::nullopt;
}

/// Likewise, of a sample without a journal: in its first images.
std::optional<CastingColour> first_casting(
    const reconstruct::SampleFolder& sample, std::int64_t last,
    const std::function<cv::Mat(const std::filesystem::path&)>& read_layer) {
  constexpr std::int64_t kLayers = 16;
  for (std::int64_t layer = 1; layer <= std::min(last, kLayers); ++layer) {
    const SurfacePrint surface = take_surface_print(read_layer(sample.layer_path(layer)));
    if (auto casting = find_light(surface, {}).casting) return casting;
  }
  return std::nullopt;
}

/// As the last layer tells it whose focus was searched; where searches are rarer than this reaches
/// back, it is told anew by the next one.
std::optional<CameraNoise> last_noise(const JournalReader& journal, std::int64_t last) {
  constexpr std::int64_t kFarthest = 1000;
  constexpr std::int64_t kAtATime = 16;
  for (std::int64_t end = last; end > std::max<std::int64_t>(0, last - kFarthest);
       end -= kAtATime) {
    const std::int64_t first = std::max<std::int64_t>(1, end - kAtATime + 1);
    const std::vector<LayerRow> layers = journal.committed_layers(first, end - first + 1);
    for (auto layer = layers.rbegin(); layer != layers.rend(); ++layer) {
      if (layer->flagged) continue;
      if (auto noise = noise_noted(layer->metrics)) return noise;
    }
  }
  return std::nullopt;
}

}  // namespace

RecalledFaces recall_faces(const reconstruct::SampleFolder& sample, std::int64_t last_committed,
                           const std::function<cv::Mat(const std::filesystem::path&)>& read_layer) {
  RecalledFaces recalled;
  if (last_committed < 1) return recalled;

  std::int64_t last_sharp = last_committed;
  std::optional<CastingColour> casting;
  if (std::filesystem::exists(sample.journal_path())) {
    constexpr std::int64_t kLayers = FaceRecord::kRemembered;
    const std::int64_t first = std::max<std::int64_t>(1, last_committed - kLayers + 1);
    const JournalReader journal(sample.journal_path());
    last_sharp = 0;
    for (const LayerRow& layer : journal.committed_layers(first, last_committed - first + 1)) {
      if (!layer.flagged) last_sharp = layer.layer;
      for (const Metric& metric : layer.metrics) {
        if (metric.name == kFaceChange) recalled.faces.recall(metric.value);
      }
    }
    casting = first_casting(journal, last_committed);
    if (const auto noise = last_noise(journal, last_committed)) {
      recalled.sharpness.know_noise(*noise);
    }
  } else {
    casting = first_casting(sample, last_committed, read_layer);
  }
  if (casting) recalled.surfaces.recall(*casting);
  const cv::Mat image = read_layer(sample.layer_path(last_committed));
  const auto face = std::make_shared<const FacePrint>(take_face_print(image));
  recalled.faces.saw(*face);
  recalled.faces.accept(last_committed, face, {});
  if (last_sharp > 0) {
    const cv::Mat sharp =
        last_sharp == last_committed ? image : read_layer(sample.layer_path(last_sharp));
    recalled.sharpness.accept(std::make_shared<const FrameMeasures>(measure_frame(sharp)));
  }
  const auto surface = std::make_shared<const SurfacePrint>(take_surface_print(image));
  recalled.surfaces.accept(last_committed, surface,
                           FrameLight{.casting = learn_casting(surface->light)});
  return recalled;
}

}  // namespace biotomy::acquisition
