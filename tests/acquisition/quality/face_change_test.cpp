#include "acquisition/quality/face_change.hpp"

#include <gtest/gtest.h>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "acquisition/quality/assessment.hpp"
#include "tests/acquisition/fake_rig.hpp"
#include "tests/acquisition/quality/phantom_photographer.hpp"

namespace biotomy::tests {
namespace {

using namespace acquisition;

/// Changes from a photograph of one depth to others.
struct Comparison {
  explicit Comparison(const PhotographerSettings& settings)
      : photographer(settings), before(take_face_print(photographer.photograph(kDepth))) {}

  double change(double deeper_um, double shift_x = 0.0, double shift_y = 0.0,
                double defocus_um = 0.0) {
    const cv::Mat image = photographer.photograph(kDepth + deeper_um, shift_x, shift_y, defocus_um);
    return measure_face_change(take_face_print(image), before).whole.value().value;
  }

  static constexpr double kDepth = 100.0;
  PhantomPhotographer photographer;
  FacePrint before;
};

TEST(FaceChange, IsNoneWhenACameraWithOneChipPhotographsCastingMaterialAgain) {
  PhotographerSettings settings{.width = 640, .height = 640, .left_um = 0.0, .top_um = 0.0};
  settings.sensor = {.mosaic = true, .photons_at_white = 4000};
  PhantomPhotographer camera(settings);
  const cv::Mat one = camera.photograph(100.0);
  const cv::Mat other = camera.photograph(100.0);
  const auto noise = noise_between(measure_frame(one), measure_frame(other));
  ASSERT_TRUE(noise && noise->face);
  const FacePrint before = take_face_print(one);
  const FacePrint now = take_face_print(other);
  const double limit = QualityThresholds{}.minimum_face_change;
  EXPECT_GT(measure_face_change(now, before).whole.value().value, limit)
      << "its noise passes for detail";
  const auto again = measure_face_change(now, before, noise->face).whole;
  ASSERT_TRUE(again);
  EXPECT_LT(again->value, limit);
  const FacePrint deeper = take_face_print(camera.photograph(120.0));
  EXPECT_GT(measure_face_change(deeper, before, noise->face).whole.value().value, 0.05);
}

class FaceChangeOfSpecimen : public testing::TestWithParam<std::uint64_t> {
 protected:
  PhotographerSettings settings_{.seed = GetParam()};
};

// Measured on larger views: the same face again 0.0000 to 0.0001, a layer of 5 µm 0.009 to 0.034,
// one of 20 µm 0.13 to 0.39; docs/decisions.md has the rest. The limits here leave room for the
// small view.

TEST_P(FaceChangeOfSpecimen, IsNoneWhenItIsPhotographedAgain) {
  EXPECT_LT(Comparison(settings_).change(0.0), 0.0003);
}

TEST_P(FaceChangeOfSpecimen, IsMarkedAfterAThinLayer) {
  const double change = Comparison(settings_).change(5.0);
  EXPECT_GT(change, 0.006);
  EXPECT_LT(change, 0.05);
}

TEST_P(FaceChangeOfSpecimen, IsLargeAfterAnUsualLayer) {
  EXPECT_GT(Comparison(settings_).change(20.0), 0.06);
}

TEST_P(FaceChangeOfSpecimen, IsNoneWhenTheBlockStandsElsewhereByAPartOfAPixelOrSome) {
  Comparison comparison(settings_);
  for (const double shift : {0.3, 1.0, 2.5, 6.0}) {
    EXPECT_LT(comparison.change(0.0, shift, -0.9 * shift), 0.0015) << shift;
  }
}

TEST_P(FaceChangeOfSpecimen, IsSeenThoughTheBlockStandsElsewhere) {
  Comparison comparison(settings_);
  EXPECT_GT(comparison.change(5.0, 2.5, 1.0), 0.005);
  EXPECT_GT(comparison.change(20.0, 2.5, 1.0), 0.06);
}

TEST_P(FaceChangeOfSpecimen, IsNoneWhenTheColumnFollowedAFaceThatStayed) {
  for (const double aperture : {0.05, 0.1, 0.3}) {
    settings_.numerical_aperture = aperture;
    EXPECT_LT(Comparison(settings_).change(0.0, 0.0, 0.0, 20.0), 0.001) << aperture;
  }
}

TEST_P(FaceChangeOfSpecimen, DoesNotGrowWithTheNoise) {
  settings_.sensor.photons_at_white = 800;
  settings_.sensor.read_noise_levels = 2.0;
  EXPECT_LT(Comparison(settings_).change(0.0), 0.002);
  const double change = Comparison(settings_).change(5.0);
  EXPECT_GT(change, 0.006);
  EXPECT_LT(change, 0.05);
}

TEST_P(FaceChangeOfSpecimen, IsNoneInAnotherLight) {
  Comparison comparison(settings_);
  cv::Mat dim;
  comparison.photographer.photograph(Comparison::kDepth).convertTo(dim, CV_8U, 0.8);
  EXPECT_LT(measure_face_change(take_face_print(dim), comparison.before).whole.value().value,
            0.001);
}

INSTANTIATE_TEST_SUITE_P(Seeds, FaceChangeOfSpecimen, testing::Values(1, 7, 23),
                         testing::PrintToStringParamName());

TEST(FaceChange, IsNotJudgedOnBareCastingMaterial) {
  const auto casting = [](std::uint64_t exposure) {
    cv::Mat image(320, 320, CV_8UC3, cv::Scalar(60, 120, 80));
    add_noise(image, exposure);
    return take_face_print(image);
  };
  EXPECT_FALSE(measure_face_change(casting(2), casting(1)).whole);
}

TEST(FaceChange, IsWholeWhereDetailAppearsOrVanishes) {
  PhantomPhotographer photographer(PhotographerSettings{});
  const FacePrint tissue = take_face_print(photographer.photograph(100.0));
  const FacePrint bare = take_face_print(cv::Mat(320, 320, CV_8UC3, cv::Scalar(60, 120, 80)));
  EXPECT_GT(measure_face_change(bare, tissue).whole.value().value, 0.99);
  EXPECT_GT(measure_face_change(tissue, bare).whole.value().value, 0.99);
}

TEST(FaceChange, IsFoundWhereItIs) {
  PhantomPhotographer photographer(PhotographerSettings{});
  const cv::Mat before = photographer.photograph(100.0);
  cv::Mat torn = photographer.photograph(120.0);
  photographer.photograph(100.0).rowRange(200, 320).copyTo(torn.rowRange(200, 320));
  const FaceChange change = measure_face_change(take_face_print(torn), take_face_print(before));
  ASSERT_EQ(change.rows.size(), 8U);
  for (const std::size_t row : {0U, 1U, 2U, 3U}) EXPECT_GT(change.rows[row].value().value, 0.03);
  for (const std::size_t row : {6U, 7U}) EXPECT_LT(change.rows[row].value().value, 0.001);
  for (const auto& column : change.columns) EXPECT_GT(column.value().value, 0.01);
}

TEST(FaceChange, BetweenFramesOfDifferentSizesIsNotJudged) {
  PhantomPhotographer photographer(PhotographerSettings{});
  const cv::Mat image = photographer.photograph(100.0);
  EXPECT_FALSE(
      measure_face_change(take_face_print(image), take_face_print(image(cv::Rect(0, 0, 200, 200))))
          .whole);
}

}  // namespace
}  // namespace biotomy::tests
