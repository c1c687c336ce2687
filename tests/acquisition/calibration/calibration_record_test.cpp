#include "acquisition/calibration/calibration_record.hpp"

#include <fstream>

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>
#include <opencv2/core.hpp>

#include "tests/reconstruct/test_files.hpp"
#include "tests/temporary_folder.hpp"

namespace biotomy::tests {
namespace {

using namespace acquisition;
using bridge::Transfer;
using testing::HasSubstr;
using testing::ThrowsMessage;

CalibrationFrame frame_of(double level) {
  CalibrationFrame frame;
  frame.mean = cv::Mat(30, 40, CV_16UC3, cv::Scalar(level, level + 1, level + 2));
  frame.bits = 8;
  frame.frames = 16;
  frame.settings = {std::chrono::microseconds(12000), 2.0, 1.5, 1.25};
  frame.taken_at = "2026-01-02T03:04:05.678Z";
  return frame;
}

class CalibrationRecord : public testing::Test {
 protected:
  std::size_t files() const { return reconstruct::names_in(calibrations_).size(); }

  TemporaryFolder folder_;
  std::filesystem::path calibrations_ = folder_ / "deep" / "calibration";
};

TEST_F(CalibrationRecord, IsReadAsItWasWritten) {
  const std::string hash = write_calibration_frame(calibrations_, FieldKind::flat, frame_of(500));
  const CalibrationFrame read =
      read_calibration_frame(calibrations_, FieldKind::flat, Transfer::linear);
  EXPECT_EQ(cv::norm(read.mean, frame_of(500).mean, cv::NORM_INF), 0.0);
  EXPECT_EQ(read.settings, frame_of(500).settings);
  EXPECT_EQ(read.bits, 8);
  EXPECT_EQ(read.frames, 16);
  EXPECT_EQ(read.taken_at, "2026-01-02T03:04:05.678Z");
  EXPECT_EQ(read.sha256, hash);
}

TEST_F(CalibrationRecord, HoldsLightWhateverTheFramesAre) {
  write_calibration_frame(calibrations_, FieldKind::flat, frame_of(500));
  const CalibrationFrame read =
      read_calibration_frame(calibrations_, FieldKind::flat, Transfer::srgb);
  EXPECT_EQ(cv::norm(read.mean, frame_of(500).mean, cv::NORM_INF), 0.0);
}

TEST_F(CalibrationRecord, OfAnEarlierVersionHoldsTheFramesOwnValues) {
  write_calibration_frame(calibrations_, FieldKind::flat, frame_of(128.0 * 257.0));
  const std::filesystem::path path = calibrations_ / "flat.json";
  auto record = nlohmann::json::parse(std::ifstream(path));
  record.erase("transfer");
  reconstruct::write_text(path, record.dump());
  const auto value_by = [&](Transfer transfer) {
    return read_calibration_frame(calibrations_, FieldKind::flat, transfer)
        .mean.at<cv::Vec3w>(3, 3)[0];
  };
  EXPECT_EQ(value_by(Transfer::linear), 128 * 257);
  EXPECT_NEAR(value_by(Transfer::srgb), 0.21586 * 65535.0, 1.0);
  record["transfer"] = "log";
  reconstruct::write_text(path, record.dump());
  EXPECT_THAT([&] { value_by(Transfer::srgb); },
              ThrowsMessage<CalibrationError>(HasSubstr("unknown transfer \"log\"")));
}

TEST_F(CalibrationRecord, TakesThePlaceOfTheFormerOneAndOfNoOther) {
  write_calibration_frame(calibrations_, FieldKind::flat, frame_of(500));
  write_calibration_frame(calibrations_, FieldKind::dark, frame_of(5));
  write_calibration_frame(calibrations_, FieldKind::flat, frame_of(700));
  EXPECT_EQ(read_calibration_frame(calibrations_, FieldKind::flat, Transfer::linear)
                .mean.at<cv::Vec3w>(0, 0)[0],
            700);
  EXPECT_EQ(read_calibration_frame(calibrations_, FieldKind::dark, Transfer::linear)
                .mean.at<cv::Vec3w>(0, 0)[0],
            5);
}

TEST_F(CalibrationRecord, IsKeptWhenAnotherTakesItsPlaceAndCanBeRestored) {
  const std::string hash = write_calibration_frame(calibrations_, FieldKind::flat, frame_of(500));
  write_calibration_frame(calibrations_, FieldKind::flat, frame_of(700));
  write_calibration_frame(calibrations_, FieldKind::flat, frame_of(900));
  EXPECT_EQ(files(), 6U);
  std::filesystem::copy_file(calibrations_ / ("flat-" + short_hash(hash) + ".json"),
                             calibrations_ / "flat.json",
                             std::filesystem::copy_options::overwrite_existing);
  const CalibrationFrame restored =
      read_calibration_frame(calibrations_, FieldKind::flat, Transfer::linear);
  EXPECT_EQ(restored.sha256, hash);
  EXPECT_EQ(restored.mean.at<cv::Vec3w>(0, 0)[0], 500);
  EXPECT_EQ(restored.settings, frame_of(500).settings);
}

TEST_F(CalibrationRecord, TakesThePlaceOfOneThatIsDamaged) {
  for (const char* text : {"", "no JSON", "[]", R"({"file": 3})", R"({"file": "../flat.tif"})"}) {
    std::filesystem::create_directories(calibrations_);
    reconstruct::write_text(calibrations_ / "flat.json", text);
    write_calibration_frame(calibrations_, FieldKind::flat, frame_of(500));
    EXPECT_EQ(files(), 2U) << text;
  }
}

TEST_F(CalibrationRecord, ThatIsMissingOrDamagedIsRefusedWithWhatToDo) {
  const auto read = [&] {
    read_calibration_frame(calibrations_, FieldKind::flat, Transfer::linear);
  };
  EXPECT_THAT(read, ThrowsMessage<CalibrationError>(HasSubstr("biotomy calibrate flat")));
  const std::string hash = write_calibration_frame(calibrations_, FieldKind::flat, frame_of(500));
  const auto image = calibrations_ / ("flat-" + hash.substr(0, 12) + ".tif");
  reconstruct::flip_byte(image, 50);
  EXPECT_THAT(read, ThrowsMessage<CalibrationError>(HasSubstr("is not what was recorded")));
  std::filesystem::remove(image);
  EXPECT_THROW(read(), CalibrationError);
  reconstruct::write_text(calibrations_ / "flat.json", "{\"kind\": \"flat\"}");
  EXPECT_THAT(read, ThrowsMessage<CalibrationError>(HasSubstr("is not a calibration's record")));
}

TEST_F(CalibrationRecord, ThatCannotBeStoredLeavesTheFormerOneInForce) {
  write_calibration_frame(calibrations_, FieldKind::flat, frame_of(500));
  // Where the record would be written there is a folder: neither can take its place.
  std::filesystem::remove(calibrations_ / "dark.json");
  std::filesystem::create_directories(calibrations_ / "dark.json" / "x");
  EXPECT_THROW(write_calibration_frame(calibrations_, FieldKind::dark, frame_of(5)),
               CalibrationError);
  EXPECT_EQ(read_calibration_frame(calibrations_, FieldKind::flat, Transfer::linear)
                .mean.at<cv::Vec3w>(0, 0)[0],
            500);
}

}  // namespace
}  // namespace biotomy::tests
