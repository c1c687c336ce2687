#include "reconstruct/section/scale_bar.hpp"

#include <cmath>
#include <string>

#include <gtest/gtest.h>

namespace biotomy::reconstruct {
namespace {

TEST(ScaleBar, IsARoundLengthOfAboutAFifthOfTheWidth) {
  for (int width = 20; width < 20'000; width += width / 7) {
    for (const double pixel : {0.03, 0.7, 1.0, 12.5, 1320.0}) {
      const ScaleBar bar = scale_bar(width, pixel);
      const double share = bar.length / (width * pixel);
      EXPECT_GT(share, 0.12);
      EXPECT_LT(share, 0.32);
      const double digit = bar.length / std::pow(10.0, std::floor(std::log10(bar.length) + 1e-9));
      EXPECT_TRUE(std::abs(digit - 1) < 1e-9 || std::abs(digit - 2) < 1e-9 ||
                  std::abs(digit - 5) < 1e-9)
          << bar.length;
      EXPECT_NEAR(bar.pixels * pixel, bar.length, 0.5 * pixel + 1e-9);
    }
  }
}

TEST(ScaleBar, IsLabelledInMicrometresOrMillimetres) {
  EXPECT_EQ(scale_bar(1000, 0.002).label, "0.5 um");
  EXPECT_EQ(scale_bar(1000, 2.5).label, "500 um");
  EXPECT_EQ(scale_bar(1000, 5.0).label, "1 mm");
  EXPECT_EQ(scale_bar(1000, 10.0).label, "2 mm");
  EXPECT_EQ(scale_bar(1000, 1000.0).label, "200 mm");
}

TEST(ScaleBar, IsAsLongAsItsLabelSaysAndNoLongerThanThePicture) {
  for (int width = 1; width < 40; ++width) {
    for (const double pixel : {0.7, 1.0, 10.0, 13.2, 19.0, 49.0, 99.9}) {
      const ScaleBar bar = scale_bar(width, pixel);
      EXPECT_NEAR(bar.pixels * pixel, bar.length, 1e-9 * bar.length) << width << ' ' << pixel;
      const double unit = bar.label.ends_with(" mm") ? 1000.0 : 1.0;
      EXPECT_DOUBLE_EQ(unit * std::stod(bar.label), bar.length);
      EXPECT_LE(bar.pixels, width * (1.0 + 1e-8)) << width << ' ' << pixel;
      EXPECT_GE(bar.pixels, 0.4) << width << ' ' << pixel;
    }
  }
}

TEST(ScaleBar, ExistsForASinglePixel) {
  EXPECT_EQ(scale_bar(1, 10.0).pixels, 1);
}

}  // namespace
}  // namespace biotomy::reconstruct
