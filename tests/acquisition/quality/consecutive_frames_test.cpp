#include "acquisition/quality/consecutive_frames.hpp"

#include <optional>

#include <gtest/gtest.h>
#include <opencv2/core.hpp>

#include "tests/acquisition/quality/phantom_photographer.hpp"

namespace biotomy::tests {
namespace {

using namespace acquisition;

constexpr double kOut = 80.0;  // µm beside the focus: leaves 0.88 of the sharpness

/// Layers of casting material, by a camera with one chip at a high gain.
struct Layers {
  Layers() {
    PhotographerSettings settings{.width = 640, .height = 480, .left_um = 0.0, .top_um = 0.0};
    settings.sensor = {.mosaic = true, .photons_at_white = 1000};
    camera.emplace(settings);
    noise = noise_between(measure_frame(photograph(1)), measure_frame(photograph(1)));
  }

  cv::Mat photograph(int layer, double defocus_um = 0.0) {
    return camera->photograph(20.0 * layer, 0.0, 0.0, defocus_um);
  }
  /// The first of which noted the noise.
  void judge_three(const std::optional<CameraNoise>& noted) {
    for (int layer = 1; layer <= 3; ++layer) judge_and_accept(layer, layer == 1 ? noted : none);
  }
  void judge_and_accept(int layer, const std::optional<CameraNoise>& noted, bool flagged = false) {
    frames.accept(frames.judge(photograph(layer), layer, noted), flagged);
  }
  bool sees_blur_of(int layer) {
    return frames.judge(photograph(layer, kOut), layer).verdict == Verdict::rejected;
  }
  /// A tenth of it, as if the camera's gain had been another.
  CameraNoise too_little() const {
    CameraNoise little = noise.value();
    for (BandNoise& band : little.bands.values) band = {0.1 * band.dark, 0.1 * band.light};
    return little;
  }

  static constexpr std::optional<CameraNoise> none{};

  std::optional<PhantomPhotographer> camera;
  std::optional<CameraNoise> noise;
  ConsecutiveFrames frames{QualityThresholds{}};
};

TEST(ConsecutiveFrames, AreJudgedByTheNoiseThatALayerNoted) {
  Layers layers;
  layers.judge_three(layers.noise);
  EXPECT_TRUE(layers.sees_blur_of(4));
}

TEST(ConsecutiveFrames, WithoutNotedNoiseAreJudgedAsIfItWereWhite) {
  Layers layers;
  layers.judge_three(Layers::none);
  EXPECT_FALSE(layers.sees_blur_of(4));
}

TEST(ConsecutiveFrames, LearnNewNoiseOnceItsLayerIsAcceptedWithoutAFlag) {
  Layers layers;
  layers.judge_three(layers.too_little());
  layers.frames.judge(layers.photograph(4), 4, layers.noise);
  EXPECT_FALSE(layers.sees_blur_of(4)) << "judged, and not accepted";
  layers.judge_and_accept(4, layers.noise, true);
  EXPECT_FALSE(layers.sees_blur_of(5)) << "accepted with a flag";
  layers.judge_and_accept(5, layers.noise);
  EXPECT_TRUE(layers.sees_blur_of(6));
}

}  // namespace
}  // namespace biotomy::tests
