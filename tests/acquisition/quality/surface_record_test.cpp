#include "acquisition/quality/surface_record.hpp"

#include <gtest/gtest.h>
#include <opencv2/core.hpp>

namespace biotomy::tests {
namespace {

using namespace acquisition;

std::shared_ptr<const SurfacePrint> print() {
  return std::make_shared<const SurfacePrint>(
      take_surface_print(cv::Mat(64, 64, CV_8UC3, cv::Scalar(50, 110, 80))));
}

FrameLight light(double level) {
  FrameLight made;
  for (SmoothSurface& colour : made.since_first.colours) colour.coefficients[0] = level;
  return made;
}

TEST(SurfaceRecord, KnowsNothingAtFirst) {
  const SurfaceRecord record;
  EXPECT_EQ(record.surface(), nullptr);
  EXPECT_FALSE(record.casting());
  EXPECT_DOUBLE_EQ(record.usual_light().brightness().mean(), 0.0);
}

TEST(SurfaceRecord, TakesTheMedianOfTheLastLayersForUsual) {
  SurfaceRecord record;
  for (const double level : {0.0, 0.01, 0.5, 0.02, 0.03}) record.accept(1, print(), light(level));
  EXPECT_DOUBLE_EQ(record.usual_light().brightness().mean(), 0.02);
  EXPECT_DOUBLE_EQ(record.last_light().brightness().mean(), 0.03);
}

TEST(SurfaceRecord, ForgetsWhatIsLongAgoButTheFirstCastingMaterial) {
  SurfaceRecord record;
  FrameLight made = light(1.0);
  made.measured.range_error = 0.3;
  made.casting = CastingColour{.level = {0.1, 0.4, 0.3}};
  record.accept(1, print(), made);
  made = light(0.0);
  made.casting = CastingColour{.level = {0.2, 0.4, 0.3}};
  for (std::size_t i = 0; i < SurfaceRecord::kRemembered; ++i) record.accept(2, print(), made);
  EXPECT_EQ(record.colours().size(), SurfaceRecord::kRemembered);
  EXPECT_DOUBLE_EQ(record.range_error(), 0.0);
  EXPECT_DOUBLE_EQ(record.first_casting()->level[0], 0.1);
  EXPECT_DOUBLE_EQ(record.casting()->level[0], 0.2);
}

}  // namespace
}  // namespace biotomy::tests
