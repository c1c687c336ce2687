#include "firmware_bridge/camera/told_settings.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace biotomy::bridge {
namespace {

using std::chrono::microseconds;
using testing::Optional;

const CameraSettings kAsked{.exposure = microseconds(20000),
                            .gain = 2.0,
                            .red_gain = 1.8,
                            .blue_gain = 1.4,
                            .lens_position = 5.0};
const ToldSettings kObeyed{.exposure = microseconds(20000),
                           .gain = 2.0,
                           .red_gain = 1.8,
                           .blue_gain = 1.4,
                           .lens_position = 5.0};

TEST(ToldSettings, OfAnObedientCameraDoNotDiffer) {
  EXPECT_EQ(difference(kAsked, kObeyed), std::nullopt);
}

TEST(ToldSettings, MayBeRounded) {
  ToldSettings told = kObeyed;
  told.exposure = microseconds(21900);
  told.gain = 1.85;
  told.lens_position = 5.04;
  EXPECT_EQ(difference(kAsked, told), std::nullopt);
}

TEST(ToldSettings, OfAShortExposureMayDifferByALine) {
  CameraSettings asked = kAsked;
  asked.exposure = microseconds(150);
  ToldSettings told = kObeyed;
  told.exposure = microseconds(100);
  EXPECT_EQ(difference(asked, told), std::nullopt);
  told.exposure = microseconds(300);
  EXPECT_NE(difference(asked, told), std::nullopt);
}

TEST(ToldSettings, DifferInWords) {
  ToldSettings told = kObeyed;
  told.exposure = microseconds(8000);
  EXPECT_THAT(difference(kAsked, told),
              Optional(std::string("an exposure in us of 8000 instead of 20000")));
  told = kObeyed;
  told.gain = 4.0;
  EXPECT_THAT(difference(kAsked, told), Optional(std::string("a gain of 4 instead of 2")));
  told = kObeyed;
  told.red_gain = 1.0;
  EXPECT_NE(difference(kAsked, told), std::nullopt);
  told = kObeyed;
  told.blue_gain = 1.0;
  EXPECT_NE(difference(kAsked, told), std::nullopt);
  told = kObeyed;
  told.lens_position = 4.9;
  EXPECT_NE(difference(kAsked, told), std::nullopt);
}

TEST(ToldSettings, ThatNobodyToldDoNotDiffer) {
  EXPECT_EQ(difference(kAsked, {}), std::nullopt);
  CameraSettings free_lens = kAsked;
  free_lens.lens_position.reset();
  ToldSettings told = kObeyed;
  told.lens_position = 1.0;
  EXPECT_EQ(difference(free_lens, told), std::nullopt);
}

TEST(ToldSettings, AreCompleteWhenAllThatTheCameraHasIsTold) {
  const SettingsOffered all{.exposure = true, .gain = true, .colour_gains = true, .lens = true};
  EXPECT_TRUE(tells_all(all, kAsked, kObeyed));
  for (const auto forget : {+[](ToldSettings& told) { told.exposure.reset(); },
                            +[](ToldSettings& told) { told.gain.reset(); },
                            +[](ToldSettings& told) { told.blue_gain.reset(); },
                            +[](ToldSettings& told) { told.lens_position.reset(); }}) {
    ToldSettings told = kObeyed;
    forget(told);
    EXPECT_FALSE(tells_all(all, kAsked, told));
  }
  EXPECT_TRUE(tells_all({.exposure = true}, kAsked, {.exposure = microseconds(1)}));
  EXPECT_TRUE(tells_all({}, kAsked, {}));
}

}  // namespace
}  // namespace biotomy::bridge
