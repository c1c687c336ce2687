#include <chrono>
#include <fstream>

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>
#include <opencv2/core.hpp>

#include "acquisition/calibration/calibration_record.hpp"
#include "acquisition/service/status_json.hpp"
#include "firmware_bridge/device_error.hpp"
#include "tests/acquisition/job_bench.hpp"

namespace biotomy::tests {
namespace {

using namespace acquisition;
using testing::HasSubstr;
using Progress = CalibrationStatus::Progress;

/// Sees a blank card by the lamp's light alone.
struct CardCamera : bridge::Camera {
  const FakeLines& lines;
  bridge::CameraSettings applied{};
  int captures = 0;
  bool gone = false;
  bridge::Transfer transfer = bridge::Transfer::linear;

  explicit CardCamera(const FakeLines& rig_lines) : lines(rig_lines) {}
  bridge::CameraDescription describe() override {
    return {.model = "card", .width = 64, .height = 48, .transfer = transfer};
  }
  void apply(const bridge::CameraSettings& settings) override { applied = settings; }
  bridge::Frame capture(std::chrono::milliseconds) override {
    if (gone) {
      throw bridge::DeviceError(bridge::DeviceError::Kind::refused, "camera: it is broken");
    }
    ++captures;
    bridge::Frame frame;
    const bool lit = lines.on.contains(bridge::OutputRole::lamp);
    frame.image = cv::Mat(48, 64, CV_8UC3, lit ? cv::Scalar(120, 150, 100) : cv::Scalar(2, 3, 1));
    return frame;
  }
};

struct JobCalibration : testing::Test {
  JobCalibration() {
    bench.settings.calibration.folder = bench.folder / "calibration";
    bench.settings.camera.settings.exposure = std::chrono::microseconds(12345);
    bench.plain_camera = &card;
    bench.start_daemon();
    bench.say(OperatorCommand::acknowledge);
  }

  OperatorReply calibrate(OperatorCommand command) {
    const OperatorReply reply = bench.say(command);
    for (int i = 0; i < 200 && calibration().progress == Progress::running; ++i) bench.tick();
    return reply;
  }
  CalibrationStatus calibration() { return bench.board.look()->calibration; }
  std::filesystem::path folder() { return bench.settings.calibration.folder; }
  bool lit() const { return bench.lines.on.contains(bridge::OutputRole::lamp); }

  JobBench bench;
  CardCamera card{bench.lines};
};

TEST_F(JobCalibration, RecordsAFlatFieldWithTheLampOn) {
  EXPECT_TRUE(calibrate(OperatorCommand::calibrate_flat).accepted);
  EXPECT_EQ(calibration().progress, Progress::done) << calibration().sentence;
  EXPECT_THAT(calibration().sentence, HasSubstr("set calibration.flat = true"));
  const CalibrationFrame flat = read_calibration_frame(folder(), FieldKind::flat, card.transfer);
  EXPECT_EQ(flat.frames, 16);
  EXPECT_EQ(flat.bits, 8);
  EXPECT_EQ(flat.settings, bench.settings.camera.settings);
  EXPECT_EQ(flat.mean.at<cv::Vec3w>(5, 5), cv::Vec3w(120 * 257, 150 * 257, 100 * 257));
  EXPECT_EQ(card.applied, bench.settings.camera.settings);
  EXPECT_EQ(card.captures, 16);
  EXPECT_FALSE(lit());
  EXPECT_EQ(bench.state(), JobState::idle);
}

TEST_F(JobCalibration, RecordsADarkFieldWithTheLampOff) {
  calibrate(OperatorCommand::calibrate_dark);
  EXPECT_EQ(calibration().progress, Progress::done) << calibration().sentence;
  EXPECT_EQ(
      read_calibration_frame(folder(), FieldKind::dark, card.transfer).mean.at<cv::Vec3w>(5, 5)[1],
      3 * 257);
}

TEST_F(JobCalibration, FindsTheGainsThatMakeACardNeutral) {
  calibrate(OperatorCommand::calibrate_white);
  EXPECT_THAT(calibration().sentence,
              HasSubstr("camera.red_gain = 1.25 and camera.blue_gain = 1.5"));
  std::ifstream file(folder() / "white.json");
  const auto record = nlohmann::json::parse(file);
  EXPECT_NEAR(record.at("red_gain").get<double>(), 1.25, 1e-4);
  EXPECT_EQ(record.at("taken_with").at("exposure_us"), 12345);
}

TEST_F(JobCalibration, IsOfTheLightBehindTheCurveOfTheCamera) {
  card.transfer = bridge::Transfer::srgb;
  calibrate(OperatorCommand::calibrate_flat);
  EXPECT_EQ(calibration().progress, Progress::done) << calibration().sentence;
  const CalibrationFrame flat =
      read_calibration_frame(folder(), FieldKind::flat, bridge::Transfer::srgb);
  EXPECT_NEAR(flat.mean.at<cv::Vec3w>(5, 5)[0] / 65535.0, 0.18782, 1e-4);
  EXPECT_NEAR(flat.mean.at<cv::Vec3w>(5, 5)[1] / 65535.0, 0.30499, 1e-4);
  calibrate(OperatorCommand::calibrate_white);
  EXPECT_THAT(calibration().sentence, HasSubstr("set camera.red_gain = 1.62"));
}

TEST_F(JobCalibration, OfFramesThatAreNotFitRecordsNothing) {
  // The rig's own camera sees squares, by whatever light, once they are in focus.
  bench.plain_camera = nullptr;
  bench.camera.column_to_face_um = 0.0;
  bench.start_daemon();
  bench.say(OperatorCommand::acknowledge);
  calibrate(OperatorCommand::calibrate_flat);
  EXPECT_EQ(calibration().progress, Progress::failed);
  EXPECT_THAT(calibration().sentence, HasSubstr("are not fit for a flat field: the surface has"));
  calibrate(OperatorCommand::calibrate_dark);
  EXPECT_THAT(calibration().sentence, HasSubstr("are not fit for a dark field"));
  EXPECT_FALSE(std::filesystem::exists(folder()));
}

TEST_F(JobCalibration, WaitsForTheLampToBeWarm) {
  bench.settings.plan.lamp_warm_up = std::chrono::seconds(2);
  bench.start_daemon();
  bench.say(OperatorCommand::acknowledge);
  bench.say(OperatorCommand::calibrate_flat);
  bench.tick(90);  // 1.8 s
  EXPECT_TRUE(lit());
  EXPECT_EQ(card.captures, 0);
  bench.tick(30);
  EXPECT_GT(card.captures, 0);
}

TEST_F(JobCalibration, EndsWithACameraThatFails) {
  card.gone = true;
  calibrate(OperatorCommand::calibrate_flat);
  EXPECT_EQ(calibration().progress, Progress::failed);
  EXPECT_EQ(calibration().sentence, "camera: it is broken");
  EXPECT_FALSE(lit());
  EXPECT_EQ(bench.state(), JobState::idle);
}

TEST_F(JobCalibration, IsRefusedUnlessTheRigIsAtRestAndWell) {
  bench.lines.inputs.door_open = true;
  bench.tick();
  EXPECT_THAT(bench.say(OperatorCommand::calibrate_flat).sentence, HasSubstr("the door is open"));
  bench.lines.inputs.door_open = false;
  bench.tick();

  bench.say(OperatorCommand::calibrate_flat);
  EXPECT_THAT(bench.say(OperatorCommand::calibrate_dark).sentence, HasSubstr("under way already"));
  EXPECT_THAT(bench.say(OperatorCommand::start).sentence, HasSubstr("wait for its end"));
  EXPECT_FALSE(bench.job->at_rest());
  EXPECT_TRUE(bench.say(OperatorCommand::abort).accepted);
  EXPECT_TRUE(bench.job->at_rest());
  EXPECT_FALSE(lit());

  bench.settings.camera.settings.exposure = std::chrono::microseconds(10000);
  bench.start_daemon();
  EXPECT_THAT(bench.say(OperatorCommand::calibrate_flat).sentence,
              HasSubstr("acknowledge it first"));
  bench.start_job();
  ASSERT_TRUE(bench.reach(JobState::grinding)) << bench.alarm();
  EXPECT_THAT(bench.say(OperatorCommand::calibrate_flat).sentence,
              HasSubstr("calibrate before it begins or after its end"));
}

TEST_F(JobCalibration, OfAFieldIsRefusedWhileASampleIsHalfMade) {
  bench.settings.camera.settings.exposure = std::chrono::microseconds(10000);
  bench.start_daemon();
  bench.start_job();
  ASSERT_TRUE(bench.reach_committed(2)) << bench.alarm();
  bench.say(OperatorCommand::abort);
  ASSERT_TRUE(bench.reach(JobState::aborted)) << bench.alarm();
  const auto expect_refusals = [&] {
    for (const auto command : {OperatorCommand::calibrate_flat, OperatorCommand::calibrate_dark}) {
      const OperatorReply reply = bench.say(command);
      EXPECT_FALSE(reply.accepted);
      EXPECT_THAT(reply.sentence, HasSubstr("has 2 of its 5 layers"));
      EXPECT_THAT(reply.sentence, HasSubstr("finish it first, or name another sample"));
    }
    EXPECT_TRUE(bench.say(OperatorCommand::calibrate_white).accepted);
    bench.say(OperatorCommand::abort);
  };
  expect_refusals();
  bench.start_daemon();
  bench.say(OperatorCommand::acknowledge);
  expect_refusals();

  bench.start_job();
  ASSERT_TRUE(bench.reach(JobState::done)) << bench.alarm();
  EXPECT_TRUE(calibrate(OperatorCommand::calibrate_flat).accepted);
  EXPECT_EQ(calibration().progress, Progress::done) << calibration().sentence;
}

TEST_F(JobCalibration, IsGivenUpWhenTheDoorIsOpened) {
  bench.settings.plan.lamp_warm_up = std::chrono::seconds(2);
  bench.start_daemon();
  bench.say(OperatorCommand::acknowledge);
  bench.say(OperatorCommand::calibrate_flat);
  bench.lines.inputs.door_open = true;
  bench.tick(2);
  EXPECT_EQ(calibration().progress, Progress::failed);
  EXPECT_THAT(calibration().sentence, HasSubstr("the door is open"));
  EXPECT_FALSE(lit());
}

TEST_F(JobCalibration, IsShownInTheStatus) {
  EXPECT_TRUE(
      nlohmann::json::parse(status_json(*bench.board.look(), {})).at("calibration").is_null());
  calibrate(OperatorCommand::calibrate_flat);
  const auto shown = nlohmann::json::parse(status_json(*bench.board.look(), {})).at("calibration");
  EXPECT_EQ(shown.at("kind"), "flat");
  EXPECT_EQ(shown.at("progress"), "done");
}

}  // namespace
}  // namespace biotomy::tests
