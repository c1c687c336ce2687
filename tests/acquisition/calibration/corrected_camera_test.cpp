#include "acquisition/calibration/corrected_camera.hpp"

#include <gmock/gmock.h>
#include <opencv2/core.hpp>

#include "acquisition/calibration/calibration_record.hpp"
#include "tests/temporary_folder.hpp"

namespace biotomy::tests {
namespace {

using namespace acquisition;
using testing::HasSubstr;
using testing::ThrowsMessage;

/// Photographs an even surface of which the right half gets half the light, with some dark signal.
struct UnevenCamera : bridge::Camera {
  cv::Size size{40, 30};
  int type = CV_8UC3;
  bridge::Transfer transfer = bridge::Transfer::linear;
  int left = 164;
  int right = 84;

  bridge::CameraDescription describe() override {
    return {.model = "uneven", .width = size.width, .height = size.height, .transfer = transfer};
  }
  void apply(const bridge::CameraSettings&) override {}
  bridge::Frame capture(std::chrono::milliseconds) override {
    bridge::Frame frame;
    const double unit = type == CV_16UC3 ? 257.0 : 1.0;
    frame.image = cv::Mat(size, type, cv::Scalar::all(left * unit));
    frame.image.colRange(size.width / 2, size.width).setTo(cv::Scalar::all(right * unit));
    return frame;
  }
};

class CorrectedFrames : public testing::Test {
 protected:
  /// What the camera sees of something twice as bright, and without light.
  void record(bool with_dark = true) const {
    CalibrationFrame flat;
    flat.mean =
        cv::Mat(camera_.size.height, camera_.size.width, CV_16UC3, cv::Scalar::all(244.0 * 257.0));
    flat.mean.colRange(20, 40).setTo(cv::Scalar::all(124.0 * 257.0));
    flat.settings = settings_;
    write_calibration_frame(folder_.path(), FieldKind::flat, flat);
    if (!with_dark) return;
    CalibrationFrame dark;
    dark.mean = cv::Mat(flat.mean.size(), CV_16UC3, cv::Scalar::all(4.0 * 257.0));
    dark.settings = settings_;
    write_calibration_frame(folder_.path(), FieldKind::dark, dark);
  }
  CorrectedCamera corrected(bool flat, bool dark) {
    return {camera_, {folder_.path(), flat, dark}};
  }

  TemporaryFolder folder_;
  UnevenCamera camera_;
  bridge::CameraSettings settings_{std::chrono::microseconds(9000), 1.5, 1.25, 1.75};
};

TEST_F(CorrectedFrames, AreEven) {
  record();
  CorrectedCamera camera = corrected(true, true);
  camera.apply(settings_);
  const cv::Mat image = camera.capture({}).image;
  EXPECT_EQ(image.at<cv::Vec3b>(3, 3), cv::Vec3b(120, 120, 120));
  EXPECT_EQ(image.at<cv::Vec3b>(3, 35), cv::Vec3b(120, 120, 120));
}

TEST_F(CorrectedFrames, AreEvenInTheLightBehindTheCurve) {
  record();
  camera_.transfer = bridge::Transfer::srgb;
  camera_.left = 210;   // what sRGB makes of 164
  camera_.right = 155;  // and of 84
  CorrectedCamera camera = corrected(true, true);
  camera.apply(settings_);
  const cv::Mat image = camera.capture({}).image;
  EXPECT_NEAR(image.at<cv::Vec3b>(3, 3)[0], 182, 1);  // what it makes of 120
  EXPECT_NEAR(image.at<cv::Vec3b>(3, 35)[0], 182, 1);
}

/// A sample must not be gone on with by a field that is applied in another way.
TEST_F(CorrectedFrames, SayThatTheLightBehindTheCurveWasCorrected) {
  record();
  CorrectedCamera camera = corrected(true, true);
  camera.apply(settings_);
  EXPECT_THAT(camera.describe().correction, testing::Not(HasSubstr("sRGB")));
  camera_.transfer = bridge::Transfer::srgb;
  camera.apply(settings_);
  EXPECT_THAT(camera.describe().correction, HasSubstr("on the light behind sRGB"));
}

TEST_F(CorrectedFrames, SayWhatTheyWereCorrectedBy) {
  record();
  CorrectedCamera camera = corrected(true, true);
  EXPECT_EQ(camera.describe().correction, "");
  camera.apply(settings_);
  const std::string hash =
      read_calibration_frame(folder_.path(), FieldKind::flat, camera_.transfer).sha256;
  EXPECT_THAT(
      camera.describe().correction,
      testing::AllOf(HasSubstr("flat field " + hash.substr(0, 12)), HasSubstr("dark field")));
}

TEST_F(CorrectedFrames, AreLeftAloneWithoutCalibrations) {
  CorrectedCamera camera = corrected(false, false);
  camera.apply(settings_);
  EXPECT_EQ(camera.capture({}).image.at<cv::Vec3b>(3, 35), cv::Vec3b(84, 84, 84));
  EXPECT_EQ(camera.describe().correction, "");
}

TEST_F(CorrectedFrames, AreRefusedWhenTheCalibrationWasTakenOtherwise) {
  record(false);
  CorrectedCamera camera = corrected(true, false);
  bridge::CameraSettings longer = settings_;
  longer.exposure *= 2;
  EXPECT_THAT([&] { camera.apply(longer); },
              ThrowsMessage<CalibrationError>(HasSubstr("was recorded with 9000 µs")));
  bridge::CameraSettings redder = settings_;
  redder.red_gain = 2.0;
  EXPECT_THROW(camera.apply(redder), CalibrationError);
  camera_.size = {44, 30};
  EXPECT_THAT([&] { camera.apply(settings_); },
              ThrowsMessage<CalibrationError>(HasSubstr("40 × 30 pixels and the camera 44 × 30")));
  EXPECT_THROW(corrected(true, true).apply(settings_), CalibrationError);
}

TEST_F(CorrectedFrames, AreCorrectedByTheSameFieldWhereverTheLensStands) {
  record();
  CorrectedCamera camera = corrected(true, true);
  camera.apply(settings_);
  bridge::CameraSettings moved = settings_;
  moved.lens_position = 4.0;
  std::filesystem::remove(folder_.path() / "flat.json");
  camera.apply(moved);
  EXPECT_EQ(camera.capture({}).image.at<cv::Vec3b>(3, 35), cv::Vec3b(120, 120, 120))
      << "the field was not read again";
  EXPECT_THROW(camera.apply(settings_), CalibrationError) << "a new job reads it";
  moved.gain *= 2.0;
  EXPECT_THROW(camera.apply(moved), CalibrationError);
}

TEST_F(CorrectedFrames, AreRefusedWhenTheyHaveOtherBits) {
  record(false);
  CorrectedCamera camera = corrected(true, false);
  camera.apply(settings_);
  camera_.type = CV_16UC3;
  EXPECT_THROW(camera.capture({}), CalibrationError);
}

}  // namespace
}  // namespace biotomy::tests
