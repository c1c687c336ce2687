#include "sim/physics/camera.hpp"

#include <gtest/gtest.h>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

namespace biotomy::sim {
namespace {

struct Studio {
  SensorSettings sensor;
  CameraOptics optics{.view = {.width = 200, .height = 200, .pixel_um = 50}};
  Phantom phantom{PhantomSettings{.detail_um = 175}};
  Scene scene{Block(1, 1000, 0, DebrisSettings{}), 0, 650, true};  // in focus: 650 + 350
  ExposureSettings exposure;
  std::uint64_t seed = 1;

  Camera camera() const { return {seed, phantom, 1000, optics, sensor}; }
  Photograph take() const { return camera().take(scene, scene, exposure); }
};

double sharpness(const cv::Mat& image) {
  cv::Mat grey;
  cv::Mat edges;
  cv::cvtColor(image, grey, cv::COLOR_RGB2GRAY);
  cv::Laplacian(grey, edges, CV_32F);
  return cv::norm(edges, cv::NORM_L2SQR);
}

TEST(Camera, ShowsThePhantomInTheSampleCoordinates) {
  Studio studio;
  studio.sensor.vignetting = 0;
  const Photograph photograph = studio.take();
  ASSERT_EQ(photograph.image.type(), CV_8UC3);
  EXPECT_TRUE(photograph.face_in_view);
  EXPECT_EQ(photograph.defocus_um, 0);
  double away = 0;
  for (int i = 5; i < 195; i += 7) {
    const Colour c = studio.phantom.colour_at(50 * i, 50 * (199 - i), 0);
    away += std::abs(photograph.image.at<cv::Vec3b>(199 - i, i)[0] - c.r);
  }
  EXPECT_LT(away / 28, 4);
}

TEST(Camera, IsSharpestInTheFocalPlaneAndBlursAlikeOnBothSides) {
  Studio studio;
  const double sharp = sharpness(studio.take().image);
  studio.scene.column_um = 650 + 3000;
  const Photograph beyond = studio.take();
  studio.scene.column_um = 650 - 3000;
  const Photograph before = studio.take();
  EXPECT_EQ(beyond.defocus_um, -3000);
  EXPECT_EQ(before.defocus_um, 3000);
  EXPECT_LT(sharpness(beyond.image), 0.7 * sharp);
  EXPECT_NEAR(sharpness(beyond.image), sharpness(before.image), 0.01 * sharp);
}

TEST(Camera, ShowsATiltedFaceSharpWhereTheFocalPlaneMeetsIt) {
  Studio studio;
  studio.sensor.read_noise_levels = 0;
  studio.sensor.photons_at_white = 1e9;
  const cv::Mat flat = studio.take().image;
  studio.optics.tilt.across_um = 8000;
  const cv::Mat tilted = studio.take().image;
  const auto kept = [&](int from, int to) {
    return sharpness(tilted.colRange(from, to)) / sharpness(flat.colRange(from, to));
  };
  EXPECT_GT(kept(95, 105), 0.75);
  EXPECT_LT(kept(50, 60), 0.6);
  EXPECT_LT(kept(140, 150), 0.6);
}

TEST(Camera, RepeatsItsNoiseForTheSameSeedAndFrameNumber) {
  Studio studio;
  Camera one = studio.camera();
  Camera same = studio.camera();
  const cv::Mat first = one.take(studio.scene, studio.scene, studio.exposure).image;
  EXPECT_EQ(cv::norm(first, same.take(studio.scene, studio.scene, studio.exposure).image), 0);
  EXPECT_GT(cv::norm(first, one.take(studio.scene, studio.scene, studio.exposure).image), 0);
  studio.seed = 2;
  EXPECT_GT(cv::norm(first, studio.take().image), 0);
}

TEST(Camera, IsNoisierWhereThereIsMoreLight) {
  SensorSettings settings;
  settings.vignetting = 0;
  const Sensor sensor(1, 300, 300, settings);
  const auto deviation = [&](double level) {
    const cv::Mat light(300, 300, CV_32FC3, cv::Scalar::all(level));
    cv::Scalar mean;
    cv::Scalar spread;
    cv::meanStdDev(sensor.expose(light, true, {}, 1), mean, spread);
    EXPECT_NEAR(mean[0], level, 0.1);
    return spread[0];
  };
  EXPECT_GT(deviation(200), 1.3 * deviation(50));
  // Photon noise sqrt(200·255/16000), read noise 0.5, rounding sqrt(1/12).
  EXPECT_NEAR(deviation(200), std::sqrt(200 * 255.0 / 16000 + 0.25 + 1 / 12.0), 0.05);
}

TEST(Camera, FollowsExposureGainAndWhiteBalance) {
  Studio studio;
  const cv::Scalar plain = cv::mean(studio.take().image);
  studio.exposure.exposure_us = 5000;
  EXPECT_NEAR(cv::mean(studio.take().image)[1], 0.5 * plain[1], 1);
  studio.exposure.gain = 2;
  studio.exposure.red_gain = 0.5;
  const cv::Scalar balanced = cv::mean(studio.take().image);
  EXPECT_NEAR(balanced[0], 0.5 * plain[0], 1);
  EXPECT_NEAR(balanced[1], plain[1], 1);
}

TEST(Camera, SeesNextToNothingWithoutTheLamp) {
  Studio studio;
  studio.scene.lamp_on = false;
  EXPECT_LT(cv::mean(studio.take().image)[1], 2);
}

TEST(Camera, DarkensWithItsLamp) {
  Studio studio;
  const double bright = cv::mean(studio.take().image)[1];
  studio.scene.lamp_share = 0.5;
  EXPECT_NEAR(cv::mean(studio.take().image)[1], 0.5 * bright, 1);
  studio.scene.lamp_share = 0;
  EXPECT_LT(cv::mean(studio.take().image)[1], 2);
}

TEST(Camera, BlursAlongTheRowsWhileItShakes) {
  Studio studio;
  const auto edges = [&](int dx, int dy) {
    cv::Mat grey;
    cv::Mat derivative;
    cv::cvtColor(studio.take().image, grey, cv::COLOR_RGB2GRAY);
    cv::Sobel(grey, derivative, CV_32F, dx, dy);
    return cv::norm(derivative, cv::NORM_L2SQR);
  };
  studio.sensor.read_noise_levels = 0;
  studio.sensor.photons_at_white = 1e9;
  const double across = edges(1, 0);
  const double down = edges(0, 1);
  studio.scene.vibration_mm_s = 10;  // 300 µm from end to end
  EXPECT_LT(edges(1, 0), 0.6 * across);
  EXPECT_GT(edges(0, 1) / down, edges(1, 0) / across);
}

TEST(Camera, SeesTheEmptyBedWhileTheBlockIsUnderTheWheel) {
  Studio studio;
  studio.scene.traverse_um = 150000;
  const Photograph photograph = studio.take();
  EXPECT_FALSE(photograph.face_in_view);
  EXPECT_NEAR(cv::mean(photograph.image)[1], 21, 3);
}

TEST(Camera, SeesDebrisUntilItIsBlownAway) {
  Studio studio;
  studio.scene.block = Block(1, 900, 0, {.specks = 100, .radius_um = 400, .hold_ms = 100});
  studio.scene.block.begin_pass(1000);
  studio.scene.block.cut_to(1);
  Scene clean = studio.scene;
  clean.block.blow(100);
  Camera camera = studio.camera();
  const cv::Mat dirty = camera.take(studio.scene, studio.scene, {}).image;
  const cv::Mat blown = camera.take(clean, clean, {}).image;
  EXPECT_GT(cv::norm(dirty, blown, cv::NORM_L1) / (3.0 * 200 * 200), 3);
  Studio fresh;
  EXPECT_LT(cv::norm(fresh.take().image, blown, cv::NORM_L1) / (3.0 * 200 * 200), 3);
}

TEST(Camera, SeesTheBlockWhereItWasShiftedTo) {
  Studio studio;
  studio.sensor.vignetting = 0;
  const cv::Mat before = studio.take().image;
  studio.scene.displacement = {.x_um = 150, .y_um = -100};
  const cv::Mat shifted = studio.take().image;
  const cv::Mat there = shifted(cv::Rect(53, 48, 100, 100));
  EXPECT_LT(cv::norm(there, before(cv::Rect(50, 50, 100, 100)), cv::NORM_L1) / 30000, 2);
}

TEST(Camera, SeesRimeWhereTheFaceIsFrosted) {
  Studio studio;
  studio.sensor.vignetting = 0;
  const cv::Mat bare = studio.take().image;
  studio.scene.film.frost = {.share = 0.3, .opacity = 0.5};
  const cv::Mat frosted = studio.take().image;
  cv::Mat least;
  cv::Mat least_before;
  cv::reduce(frosted.reshape(1, 200 * 200), least, 1, cv::REDUCE_MIN);
  cv::reduce(bare.reshape(1, 200 * 200), least_before, 1, cv::REDUCE_MIN);
  // A veil of a half lifts the weakest colour of nearly everything by far more than noise does.
  const cv::Mat whiter = least > least_before + 12;
  EXPECT_NEAR(cv::countNonZero(whiter) / 40000.0, 0.32, 0.08);
}

TEST(Camera, SeesSpotsThatAreTooBrightWhereTheFaceGlares) {
  Studio studio;
  studio.scene.film.glare.share = 0.01;
  const cv::Mat image = studio.take().image;
  cv::Mat least;
  cv::reduce(image.reshape(1, 200 * 200), least, 1, cv::REDUCE_MIN);
  EXPECT_NEAR(cv::countNonZero(least == 255) / 40000.0, 0.01, 0.003);
}

TEST(Camera, ShowsLightThatIsUnevenOrColoured) {
  Studio studio;
  const cv::Mat plain = studio.take().image;
  studio.scene.lamp_field = {.slope_x = 0.2, .slope_y = 0, .colour = {1.1, 1, 0.9}};
  const cv::Mat lit = studio.take().image;
  const auto ratio = [&](int x, int channel) {
    const cv::Rect strip(x, 0, 10, 200);
    return cv::mean(lit(strip))[channel] / cv::mean(plain(strip))[channel];
  };
  EXPECT_NEAR(ratio(0, 1), 0.905, 0.01);
  EXPECT_NEAR(ratio(190, 1), 1.095, 0.01);
  EXPECT_NEAR(ratio(95, 0), 1.1, 0.01);
  EXPECT_NEAR(ratio(95, 2), 0.9, 0.01);
}

TEST(Camera, ShowsTheStepOfABrokenPass) {
  Studio studio;
  studio.scene.block.begin_pass(1600);
  studio.scene.block.cut_to(0.5);
  Studio fresh;
  studio.scene.block.blow(1e6);
  studio.scene.column_um = 650 + 300;
  fresh.scene.column_um = 650;
  const cv::Mat difference = cv::abs(studio.take().image - fresh.take().image);
  const double left = cv::mean(difference(cv::Rect(20, 20, 70, 160)))[0];
  const double right = cv::mean(difference(cv::Rect(110, 20, 70, 160)))[0];
  EXPECT_GT(left, 2 * right);
}

TEST(Camera, WithOneChipSeesOneColourAPixelAndInterpolatesTheOthers) {
  Studio studio;
  const cv::Mat all = studio.take().image;
  studio.sensor.mosaic = true;
  const cv::Mat mosaic = studio.take().image;
  ASSERT_EQ(mosaic.type(), CV_8UC3);
  for (int y = 60; y < 64; ++y) {
    for (int x = 60; x < 64; ++x) {
      const int seen = x % 2 + y % 2;
      EXPECT_EQ(mosaic.at<cv::Vec3b>(y, x)[seen], all.at<cv::Vec3b>(y, x)[seen]) << x << ", " << y;
    }
  }
  EXPECT_LT(cv::norm(cv::mean(mosaic) - cv::mean(all)), 2.0);
  EXPECT_NE(cv::norm(mosaic, all), 0.0);
}

TEST(Camera, TakesSixteenBitsIfToldTo) {
  Studio studio;
  const double mean = cv::mean(studio.take().image)[1];
  studio.sensor.bits = 16;
  const cv::Mat image = studio.take().image;
  ASSERT_EQ(image.type(), CV_16UC3);
  EXPECT_NEAR(cv::mean(image)[1], 257 * mean, 257);
}

}  // namespace
}  // namespace biotomy::sim
