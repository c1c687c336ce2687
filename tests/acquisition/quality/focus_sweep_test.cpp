#include "acquisition/quality/focus_sweep.hpp"

#include <cstdint>
#include <ostream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <opencv2/core.hpp>

#include "tests/acquisition/quality/made_up_sweep.hpp"

namespace biotomy::tests {
namespace {

using acquisition::rank_sweep;
using acquisition::SweepRanking;
using Field = MadeUpSweep::Field;

/// Radii of nine frames of which number 5 is in focus, the focus between frames.
const std::vector<double> kThroughTheFocus{6.5, 5.2, 3.9, 2.6, 1.3, 0.2, 1.1, 2.4, 3.7};

SweepRanking rank(const MadeUpSweep& sweep) {
  return rank_sweep(sweep.frames(), [&](std::size_t number) { return sweep.frame(number); });
}

struct Hard {
  const char* name;
  MadeUpSweep sweep;
  std::size_t sharpest;
};

void PrintTo(const Hard& hard, std::ostream* out) {
  *out << hard.name;
}

class HardSweeps : public testing::TestWithParam<Hard> {};

TEST_P(HardSweeps, AreRankedAllTheSame) {
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    MadeUpSweep sweep = GetParam().sweep;
    sweep.seed = seed;
    const SweepRanking ranking = rank(sweep);
    EXPECT_EQ(ranking.sharpest, GetParam().sharpest) << "seed " << seed;
    EXPECT_TRUE(ranking.certain) << "seed " << seed;
  }
}

INSTANTIATE_TEST_SUITE_P(
    , HardSweeps,
    testing::Values(
        Hard{"Plain", {.blur_px = kThroughTheFocus}, 5},
        Hard{"OfSixteenBits", {.type = CV_16UC3, .blur_px = kThroughTheFocus}, 5},
        Hard{"Grey", {.grey = true, .blur_px = kThroughTheFocus}, 5},
        Hard{"Small", {.size = {97, 83}, .blur_px = kThroughTheFocus}, 5},
        Hard{"OfTwoFrames", {.blur_px = {1.0, 0.4}}, 1},
        Hard{"NeverInFocus", {.blur_px = {9.0, 8.0, 7.0, 8.0, 9.0}}, 2},
        Hard{"DominatedByNoise", {.contrast = 0.02, .noise = 0.04, .blur_px = kThroughTheFocus}, 5},
        Hard{"OfAFewMarks", {.field = Field::a_few_marks, .blur_px = kThroughTheFocus}, 5},
        Hard{"WithAFadingLamp",
             {.blur_px = kThroughTheFocus,
              .exposure = {1.4, 1.3, 1.2, 1.0, 0.8, 0.7, 0.6, 0.5, 0.4}},
             5},
        Hard{"WithABrighteningLamp",
             {.blur_px = kThroughTheFocus,
              .exposure = {0.4, 0.5, 0.6, 0.7, 0.8, 1.0, 1.2, 1.3, 1.4}},
             5},
        Hard{"WithNoiseThatGrows",
             {.noise = 0.01,
              .blur_px = kThroughTheFocus,
              .noise_gain = {1.0, 1.0, 1.2, 1.4, 1.7, 2.0, 2.4, 2.8, 3.4}},
             5},
        Hard{"WithNoiseThatFalls",
             {.noise = 0.01,
              .blur_px = kThroughTheFocus,
              .noise_gain = {3.4, 2.8, 2.4, 2.0, 1.7, 1.4, 1.2, 1.0, 1.0}},
             5},
        Hard{"OfAFewMarksWithNoiseThatGrows",
             {.field = Field::a_few_marks,
              .blur_px = kThroughTheFocus,
              .noise_gain = {1.0, 1.0, 1.1, 1.2, 1.3, 1.5, 1.7, 1.9, 2.2}},
             5},
        Hard{"ThatBreathes", {.blur_px = kThroughTheFocus, .breathing = 0.01}, 5},
        Hard{"OfMarksThatBreathe",
             {.field = Field::a_few_marks, .blur_px = kThroughTheFocus, .breathing = -0.01},
             5},
        Hard{"WithBrightSpots",
             {.contrast = 0.04, .blur_px = kThroughTheFocus, .bright_spots = 20},
             5},
        Hard{"WithLargeBrightSpots",
             {.contrast = 0.04,
              .blur_px = kThroughTheFocus,
              .bright_spots = 12,
              .spot_brightness = 3.0,
              .spot_radius_px = 25.0},
             5},
        Hard{"Oversaturated", {.brightness = 0.8, .contrast = 0.4, .blur_px = kThroughTheFocus}, 5},
        Hard{"OversaturatedOnOneSide",
             {.brightness = 0.5,
              .blur_px = kThroughTheFocus,
              .exposure = {4.0, 3.0, 2.0, 1.5, 1.2, 1.0, 1.0, 1.0, 1.0}},
             5}),
    [](const auto& hard) { return std::string(hard.param.name); });

TEST(FocusSweep, NamesWhereTheFocusLiesBetweenFrames) {
  // The same distance from both middle frames, and nearer to the first of them.
  const SweepRanking between = rank({.blur_px = {3.5, 2.5, 1.5, 1.5, 2.5, 3.5}});
  ASSERT_TRUE(between.peak.has_value());
  EXPECT_NEAR(*between.peak, 2.5, 0.1);
  const SweepRanking nearer = rank({.blur_px = {3.2, 2.2, 1.2, 1.8, 2.8, 3.8}});
  ASSERT_TRUE(nearer.peak.has_value());
  EXPECT_GT(*nearer.peak, 2.0);
  EXPECT_LT(*nearer.peak, 2.5);
}

TEST(FocusSweep, DoesNotSayWhereTheFocusIsWhenItMayLieBeyondTheSweep) {
  EXPECT_EQ(rank({.blur_px = {4.0, 3.0, 2.0}}).peak, std::nullopt);
  EXPECT_EQ(rank({.blur_px = {2.0, 3.0, 4.0}}).peak, std::nullopt);
}

TEST(FocusSweep, OfNothingButNoiseIsNotCertain) {
  const MadeUpSweep even{.field = Field::even, .noise = 0.02, .blur_px = kThroughTheFocus};
  EXPECT_FALSE(rank(even).certain);
}

TEST(FocusSweep, OfOneSceneTwiceIsNotCertain) {
  EXPECT_FALSE(rank({.blur_px = {2.0, 2.0}}).certain);
}

TEST(FocusSweep, CountsTheTilesThatAreSharpestInAFrame) {
  MadeUpSweep deep{.blur_px = kThroughTheFocus};
  deep.deep_part = 0.25;
  deep.deep_frames = 2;
  const SweepRanking ranking = rank(deep);
  EXPECT_EQ(ranking.sharpest, 5U);
  EXPECT_GT(ranking.frames[5].sharpest_tiles, 2 * ranking.frames[7].sharpest_tiles);
  EXPECT_GT(ranking.frames[7].sharpest_tiles, 10);
  EXPECT_EQ(ranking.frames[2].sharpest_tiles, 0);
}

TEST(FocusSweep, WithoutLightIsRefused) {
  const auto black = [](std::size_t) { return cv::Mat(64, 64, CV_8UC3, cv::Scalar::all(0)); };
  EXPECT_THROW(rank_sweep(3, black), acquisition::UnfitSweep);
}

TEST(FocusSweep, ThatIsClippedNearlyEverywhereIsRefused) {
  // Half of each frame, and each another half: no part of the field is left.
  const auto clipped = [](std::size_t number) {
    cv::Mat frame(64, 64, CV_8UC3, cv::Scalar::all(90));
    frame.rowRange(number == 0 ? cv::Range(0, 32) : cv::Range(32, 64)).setTo(255);
    return frame;
  };
  EXPECT_THROW(rank_sweep(2, clipped), acquisition::UnfitSweep);
}

TEST(FocusSweep, OfFramesOfDifferentSizesIsRefused) {
  const auto growing = [](std::size_t number) {
    return cv::Mat(64, 64 + static_cast<int>(number), CV_8UC3, cv::Scalar::all(90));
  };
  EXPECT_THROW(rank_sweep(2, growing), acquisition::UnfitSweep);
  EXPECT_THROW(rank_sweep(1, growing), acquisition::UnfitSweep);
}

}  // namespace
}  // namespace biotomy::tests
