#include "acquisition/quality/noise_judgement.hpp"

#include <algorithm>
#include <array>

namespace biotomy::acquisition {
namespace {

struct NoiseMetrics {
  DetailBand band;
  const char* dark;
  const char* light;
};

constexpr std::array<NoiseMetrics, kDetailBands> kNoiseMetrics = {{
    {DetailBand::curvature, "noise_curvature_dark", "noise_curvature_light"},
    {DetailBand::fine, "noise_fine_dark", "noise_fine_light"},
    {DetailBand::middle, "noise_middle_dark", "noise_middle_light"},
    {DetailBand::coarse, "noise_coarse_dark", "noise_coarse_light"},
}};

constexpr const char* kFaceDark = "noise_face_dark";
constexpr const char* kFaceLight = "noise_face_light";

/// Passed, whatever they are: no frame is rejected for the camera's noise.
void note(const CameraNoise& noise, std::vector<Metric>& metrics) {
  const auto add = [&](const char* name, double value) {
    metrics.push_back({.name = name, .value = value, .limit = 1.0, .passed = true});
  };
  for (const NoiseMetrics& of : kNoiseMetrics) {
    add(of.dark, noise.bands[of.band].dark);
    add(of.light, noise.bands[of.band].light);
  }
  if (noise.face) {
    add(kFaceDark, noise.face->dark);
    add(kFaceLight, noise.face->light);
  }
}

std::optional<double> value_of(const char* name, const std::vector<Metric>& metrics) {
  const auto found = std::ranges::find(metrics, name, &Metric::name);
  if (found == metrics.end()) return std::nullopt;
  return found->value;
}

}  // namespace

void judge_noise(std::int64_t layer, SharpnessRecord& record, Judgement& judgement) {
  Assessment& result = judgement.result();
  if (record.peak() && record.peak_layer() == layer) {
    result.noise = noise_between(*record.peak(), *result.measures);
  }
  if (result.noise) {
    note(*result.noise, result.metrics);
    if (!record.noise()) record.know_noise(*result.noise);
  }
  result.measures = record.expressed(std::move(result.measures));
}

std::optional<CameraNoise> noise_noted(const std::vector<Metric>& metrics) {
  CameraNoise noise;
  for (const NoiseMetrics& of : kNoiseMetrics) {
    const auto dark = value_of(of.dark, metrics);
    const auto light = value_of(of.light, metrics);
    if (!dark || !light) return std::nullopt;
    noise.bands[of.band] = {.dark = *dark, .light = *light};
  }
  const auto dark = value_of(kFaceDark, metrics);
  const auto light = value_of(kFaceLight, metrics);
  if (dark && light) noise.face = BandNoise{.dark = *dark, .light = *light};
  return noise;
}

}  // namespace biotomy::acquisition
