#include "tests/virtual_camera/virtual_camera.hpp"

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <thread>

#include <gtest/gtest.h>
#include <malloc.h>
#include <nlohmann/json.hpp>
#include <opencv2/core.hpp>

#include "firmware_bridge/camera/libcamera_camera.hpp"
#include "firmware_bridge/camera/libcamera_listing.hpp"
#include "reconstruct/sample/layer_image.hpp"
#include "reconstruct/sample/sample_folder.hpp"
#include "tests/integration/simulated_rig.hpp"
#include "tests/virtual_camera/photographed_job.hpp"
#include "tests/virtual_camera/shown_images.hpp"

namespace biotomy::tests {
namespace {

using std::chrono::seconds;

/// What is lost on the way: the quantisation of a JPEG of quality 100, colours at half the
/// resolution (NV12), and rounding of Y, Cb, Cr to whole levels. Reached: 37.3 dB.
constexpr double kLeastDecibels = 36.8;

/// Which of the pictures an image is: of those of one face, too, each has a noise of its own, which
/// brings the others to 36.6 dB at most.
std::size_t number_of(const cv::Mat& image, const std::vector<cv::Mat>& pictures) {
  std::size_t nearest = 0;
  double most = 0.0;
  for (std::size_t i = 0; i < pictures.size(); ++i) {
    const double decibels = cv::PSNR(image, pictures[i]);
    if (decibels > most) nearest = i;
    most = std::max(most, decibels);
  }
  EXPECT_GT(most, kLeastDecibels) << "nearest is picture " << nearest;
  return nearest;
}

class VirtualCameraTest : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    // libcamera 0.4's virtual pipeline leaves a frame's status as the memory was. Here, and in the
    // daemon, no memory that is used again says by chance that a frame is spoilt.
    constexpr int kFill = 0xFF;
    ::mallopt(M_PERTURB, kFill);
    ::setenv("MALLOC_PERTURB_", std::to_string(kFill).c_str(), 1);
    missing_ = take_own_usr_share();
    if (missing_) return;
    const VirtualCamera camera(std::vector{cv::Mat(48, 64, CV_8UC3, cv::Scalar::all(128))});
    if (bridge::list_libcamera_cameras().empty()) {
      missing_ = "this libcamera was built without the virtual pipeline";
    }
  }

  void SetUp() override {
    if (!missing_) return;
    ASSERT_EQ(std::getenv("BIOTOMY_VIRTUAL_CAMERA"), nullptr) << "it is required: " << *missing_;
    GTEST_SKIP() << *missing_ << "; scripts/test-debian13 has all that this test needs";
  }

  static std::optional<std::string> missing_;
};

std::optional<std::string> VirtualCameraTest::missing_;

TEST_F(VirtualCameraTest, IsListedWithItsModelAndWhatItOffers) {
  const VirtualCamera shown(std::vector{cv::Mat(48, 64, CV_8UC3, cv::Scalar::all(128))});
  const auto cameras = bridge::list_libcamera_cameras();
  ASSERT_EQ(cameras.size(), 1U);
  EXPECT_EQ(cameras.front().id, "Virtual0");
  EXPECT_EQ(cameras.front().model, VirtualCamera::kModel);
  EXPECT_EQ(cameras.front().trouble, "");
  ASSERT_EQ(cameras.front().formats.size(), 1U);
  EXPECT_EQ(cameras.front().formats.front().name, "NV12");
  EXPECT_TRUE(cameras.front().formats.front().is_readable);
  EXPECT_EQ(cameras.front().formats.front().sizes, std::vector<std::string>{"64x48"});
}

TEST_F(VirtualCameraTest, GivesTheVeryImages) {
  const PhotographedJob job{.layers = 3};
  const std::vector<cv::Mat> pictures = photograph(job).all;
  const VirtualCamera shown(shown_in_turn(pictures));
  bridge::LibcameraCamera camera(bridge::LibcameraSettings{});

  const bridge::CameraDescription description = camera.describe();
  EXPECT_EQ(description.model, VirtualCamera::kModel);
  EXPECT_EQ(description.width, job.width);
  EXPECT_EQ(description.height, job.height);
  EXPECT_FALSE(description.lens.has_value());

  camera.apply(VirtualCamera::settings());
  for (std::size_t i = 0; i < pictures.size(); ++i) {
    const cv::Mat image = camera.capture(seconds(5)).image;
    std::this_thread::sleep_for(kBetweenCaptures);
    ASSERT_EQ(image.size(), pictures[i].size());
    ASSERT_EQ(image.type(), CV_8UC3);
    EXPECT_EQ(number_of(image, pictures), i);
  }
}

TEST_F(VirtualCameraTest, GivesAViewfinderBesideTheStillWhenAsked) {
  const VirtualCamera shown(std::vector{cv::Mat(48, 64, CV_8UC3, cv::Scalar(200, 100, 50))});
  {
    bridge::LibcameraCamera plain(bridge::LibcameraSettings{});
    plain.apply(VirtualCamera::settings());
    EXPECT_TRUE(plain.capture(seconds(5)).viewfinder.empty());
  }
  bridge::LibcameraCamera camera(bridge::LibcameraSettings{.viewfinder_width = 32});
  camera.apply(VirtualCamera::settings());
  const bridge::Frame frame = camera.capture(seconds(5));
  EXPECT_EQ(frame.image.size(), cv::Size(64, 48));
  // This pipeline has streams of one size only, and says what it gives instead.
  ASSERT_EQ(frame.viewfinder.size(), cv::Size(64, 48));
  EXPECT_GT(cv::PSNR(frame.viewfinder, frame.image), 40.0);
}

// The daemon with libcamera as its camera, on the twin's stage and lines: all of its checks are at
// work, on the pictures that the twin's optics give for this specimen.
TEST_F(VirtualCameraTest, TakesTheLayersOfAWholeJob) {
  const PhotographedJob job;
  const JobPictures pictures = photograph(job);
  const VirtualCamera shown(shown_in_turn(pictures.all));

  RigPlan plan{.layers = job.layers, .pixel_um = job.pixel_um};
  plan.layer_thickness_um = job.layer_um;
  plan.time_scale = 50;  // so that the requests of a capture are back before the next
  plan.daemon_camera =
      std::string("backend = \"libcamera\"\ncamera = \"") + VirtualCamera::kModel +
      "\"\nexposure_us = " + std::to_string(VirtualCamera::settings().exposure.count()) + "\n";
  plan.daemon_focus_settings = "step_um = " + std::to_string(job.focus_step_um) + "\n";
  SimulatedRig rig(plan);
  rig.start_daemon();
  const Outcome started = rig.rig("start");
  ASSERT_EQ(started.exit_code, 0) << started.errors;
  const Outcome watched = rig.rig("watch", seconds(200));
  ASSERT_EQ(watched.exit_code, 0) << watched.output << watched.errors << rig.status().dump(1);
  EXPECT_EQ(rig.status().at("committed"), job.layers);
  EXPECT_EQ(rig.end_daemon().exit_code, 0);

  const Outcome verified = run({BIOTOMY_TOOL, "verify", rig.sample()}, rig.folder());
  EXPECT_EQ(verified.exit_code, 0) << verified.output << verified.errors;
  const auto sample = reconstruct::SampleFolder::open(rig.sample());
  for (int layer = 1; layer <= job.layers; ++layer) {
    const cv::Mat image = reconstruct::read_layer_image(sample.layer_path(layer));
    ASSERT_EQ(image.size(), pictures.all.front().size());
    EXPECT_EQ(number_of(image, pictures.all),
              pictures.of_layer.at(static_cast<std::size_t>(layer) - 1))
        << "layer " << layer;
  }
}

}  // namespace
}  // namespace biotomy::tests
