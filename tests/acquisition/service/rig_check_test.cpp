#include "acquisition/service/rig_check.hpp"

#include <algorithm>
#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "acquisition/records/sample_lock.hpp"
#include "firmware_bridge/device_error.hpp"
#include "tests/acquisition/job_bench.hpp"

namespace biotomy::tests {
namespace {

using namespace acquisition;
using std::chrono::milliseconds;
using testing::AllOf;
using testing::Contains;
using testing::Field;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using Kind = RigFinding::Kind;

auto finding(Kind kind, const std::string& part, const std::string& text) {
  return AllOf(Field(&RigFinding::kind, kind), Field(&RigFinding::part, part),
               Field(&RigFinding::text, HasSubstr(text)));
}

auto wrong(const std::string& part, const std::string& text) {
  return finding(Kind::wrong, part, text);
}

/// A device that outlives those who are given it.
template <typename Device>
std::shared_ptr<Device> borrowed(Device& device) {
  return {&device, [](Device*) {}};
}

/// The configuration and the fakes of a job's bench, looked at by a check.
struct RigCheck : testing::Test {
  JobBench bench;
  Configuration configuration;
  bool lamp_was_on = false;  ///< while the trial frame was taken
  RigCheckParts parts;

  RigCheck() {
    configuration.stage.endpoint = "tcp://rig:502";
    configuration.service.token_file = bench.folder / "token";
    configuration.service.host = "127.0.0.1";
    configuration.service.port = 0;
    parts = {.make_stage = [this] { return borrowed<bridge::Stage>(bench.stage); },
             .make_lines = [this] { return borrowed<bridge::Lines>(bench.lines); },
             .make_camera = [this] { return borrowed<bridge::Camera>(bench.camera); },
             .surroundings = bench.surroundings,
             .now = [this] { return bench.now; },
             .wait =
                 [this](milliseconds time) {
                   bench.now += time;
                   lamp_was_on = lamp_was_on || bench.lines.on.contains(bridge::OutputRole::lamp);
                 }};
  }

  RigFindings check() {
    configuration.job = bench.settings;
    return check_rig(configuration, parts);
  }

  std::vector<std::string> files() const {
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(bench.folder.path())) {
      names.push_back(std::filesystem::relative(entry.path(), bench.folder.path()));
    }
    std::sort(names.begin(), names.end());
    return names;
  }
};

TEST_F(RigCheck, FindsThatAJobCouldStart) {
  const RigFindings findings = check();
  EXPECT_TRUE(findings.can_start()) << findings_text(findings);
  for (const char* part : {"controller", "plan", "lines", "camera", "sample", "disk", "clock"}) {
    EXPECT_THAT(findings.all(), Contains(finding(Kind::good, part, ""))) << part;
  }
  EXPECT_THAT(findings_text(findings), testing::EndsWith("a job could start\n"));
}

TEST_F(RigCheck, MovesNothingAndMakesNothing) {
  bench.start_daemon();
  bench.stage.handed_over.clear();
  int exchanges = 0;
  bench.stage.on_exchange = [&] { ++exchanges; };
  check();
  EXPECT_THAT(bench.stage.handed_over, IsEmpty());
  EXPECT_EQ(exchanges, 0) << "a heartbeat makes the controller watch for the next";
  EXPECT_THAT(bench.lines.on, IsEmpty());
  EXPECT_THAT(files(), IsEmpty());
}

TEST_F(RigCheck, GoesOnAfterEveryDeviceThatFails) {
  bench.stage.silent = true;
  parts.make_lines = []() -> std::shared_ptr<bridge::Lines> {
    throw bridge::DeviceError(bridge::DeviceError::Kind::configuration, "lines: no such chip");
  };
  bench.camera.gone = true;
  const RigFindings findings = check();
  EXPECT_THAT(findings.all(), Contains(wrong("controller", "stage: no answer")));
  EXPECT_THAT(findings.all(), Contains(wrong("lines", "lines: no such chip")));
  EXPECT_THAT(findings.all(), Contains(wrong("camera", "camera: gone")));
  EXPECT_THAT(findings.all(), Contains(finding(Kind::good, "clock", "2026-11-01")));
  EXPECT_FALSE(findings.can_start());
  EXPECT_THAT(findings_text(findings), testing::EndsWith("a job would not start: 3 things are "
                                                         "wrong\n"));
}

TEST_F(RigCheck, ShowsAllThatIsBeyondTheLimits) {
  bench.stage.identity.watchdog_timeout = milliseconds(0);
  bench.stage.identity.feed.maximum = {1079.0};
  bench.stage.identity.column.maximum = {650.0};
  const RigFindings findings = check();
  EXPECT_THAT(findings.all(), Contains(wrong("controller", "does not watch the daemon's")));
  EXPECT_THAT(findings.all(), Contains(wrong("controller", "layer 5 would be at 1080 µm")));
  EXPECT_THAT(findings.all(), Contains(wrong("controller", "the focus of the last layer would")));
}

TEST_F(RigCheck, ShowsAWatchdogThatBarksTooLate) {
  bench.stage.identity.watchdog_timeout = milliseconds(60000);
  EXPECT_THAT(check().all(), Contains(wrong("controller", "next heartbeat for 60000 ms")));
}

TEST_F(RigCheck, TellsLinesAndControllerApart) {
  bench.lines.inputs = {.estop_pressed = true, .door_open = true};
  bench.stage.status.interlocks.door_open = true;
  const RigFindings findings = check();
  EXPECT_THAT(findings.all(), Contains(wrong("lines", "the e-stop is pressed (line)")));
  EXPECT_THAT(findings.all(), Contains(wrong("lines", "the door is open (line)")));
  EXPECT_THAT(findings.all(), Contains(wrong("controller", "the door is open (controller)")));
  EXPECT_THAT(findings.all(), Contains(wrong("lines", "disagree about the e-stop")));
  EXPECT_THAT(findings.all(), Not(Contains(wrong("lines", "disagree about the door"))));
}

TEST_F(RigCheck, LightsTheTrialFrameOnlyOfARigThatIsShut) {
  check();
  EXPECT_TRUE(lamp_was_on);
  lamp_was_on = false;
  bench.lines.inputs.door_open = true;
  EXPECT_THAT(check().all(),
              Contains(finding(Kind::good, "camera", "trial frame 2, the lamp off")));
  EXPECT_FALSE(lamp_was_on);
}

TEST_F(RigCheck, SwitchesTheLampOffAgainWhenThereIsNoFrame) {
  parts.wait = [&](milliseconds) { bench.camera.gone = !bench.lines.on.empty(); };
  EXPECT_THAT(check().all(), Contains(wrong("camera", "camera: gone")));
  EXPECT_THAT(bench.lines.on, IsEmpty());
}

TEST_F(RigCheck, SeesThatTheControllersProgramStandsStill) {
  bench.stage.heart_stopped = true;
  EXPECT_THAT(check().all(), Contains(wrong("controller", "heartbeat stands still")));
}

TEST_F(RigCheck, DoesNotTakeForWrongWhatAnAcknowledgementCures) {
  constexpr std::uint16_t kWatchdog = 3;
  bench.stage.fault(kWatchdog);
  const RigFindings findings = check();
  EXPECT_TRUE(findings.can_start()) << findings_text(findings);
  EXPECT_THAT(findings.all(), Contains(finding(Kind::note, "controller",
                                               "the controller is faulted: watchdog; "
                                               "acknowledging resets it")));
}

TEST_F(RigCheck, ComparesTheTrialFrameWithWhatWasAskedFor) {
  bench.settings.camera.settings.exposure = std::chrono::microseconds(15000);
  bench.settings.plan.bits = 16;
  const RigFindings findings = check();
  EXPECT_THAT(findings.all(),
              Contains(wrong("camera", "the camera took a frame with an exposure in us of")));
  EXPECT_THAT(findings.all(), Contains(wrong("camera", "job.bits is 16")));
}

TEST_F(RigCheck, SaysHowTheTrialFrameWasTaken) {
  EXPECT_THAT(check().all(), Contains(finding(Kind::good, "camera",
                                              "exposure 10000 µs, gain 1, mean brightness")));
}

TEST_F(RigCheck, NotesAFrameThatIsTooDark) {
  bench.camera.black_frames = 1;
  EXPECT_THAT(check().all(), Contains(finding(Kind::note, "camera", "a face as dark as this")));
}

TEST_F(RigCheck, RefusesACalibrationThatIsNotThere) {
  bench.settings.calibration.folder = bench.folder / "calibration";
  bench.settings.calibration.flat = true;
  const RigFindings findings = check();
  EXPECT_THAT(findings.all(), Contains(wrong("calibration", "")));
  EXPECT_THAT(findings.all(), Contains(finding(Kind::good, "camera", "trial frame 1")));
}

TEST_F(RigCheck, CountsTheRoomOnTheDiskInLayers) {
  bench.free_bytes = std::uintmax_t{2} * 2 * 96 * 64 * 3;
  const RigFindings findings = check();
  EXPECT_THAT(findings.all(), Contains(wrong("disk", "room for 2 more layers, less than")));
  EXPECT_THAT(findings.all(),
              Contains(wrong("disk", "room for 2 more layers and the job needs 5")));
}

TEST_F(RigCheck, GoesOnWithASampleThatAgrees) {
  bench.start_job();
  ASSERT_TRUE(bench.reach(JobState::storing));
  ASSERT_TRUE(bench.reach(JobState::grinding));
  bench.say(OperatorCommand::abort);
  ASSERT_TRUE(bench.reach(JobState::aborted));
  bench.job.reset();
  const std::vector<std::string> before = files();
  const RigFindings findings = check();
  EXPECT_TRUE(findings.can_start()) << findings_text(findings);
  EXPECT_THAT(findings.all(),
              Contains(finding(Kind::good, "sample", "1 of 5 layers are committed")));
  EXPECT_THAT(findings.all(), Contains(finding(Kind::good, "sample", "next is layer 2")));
  EXPECT_EQ(files(), before);
}

TEST_F(RigCheck, SaysWhatDoesNotAgreeWithTheSample) {
  bench.start_job();
  ASSERT_TRUE(bench.reach(JobState::storing));
  ASSERT_TRUE(bench.reach(JobState::grinding));
  bench.say(OperatorCommand::abort);
  ASSERT_TRUE(bench.reach(JobState::aborted));
  bench.job.reset();
  bench.settings.camera.settings.red_gain = 1.25;
  bench.settings.plan.layers = 6;
  bench.stage.status.grind_count += 3;
  bench.wall_clock_start -= std::chrono::days(30);
  const RigFindings findings = check();
  EXPECT_THAT(findings.all(), Contains(wrong("sample", "camera.red_gain = 1")));
  EXPECT_THAT(findings.all(), Contains(wrong("sample", "the job would make")));
  EXPECT_THAT(findings.all(), Contains(wrong("sample", "disagrees with the controller")));
  EXPECT_THAT(findings.all(), Contains(wrong("clock", "the journal's last record is of")));
}

TEST_F(RigCheck, SaysThatTheFolderAroundTheSampleIsMissing) {
  bench.settings.plan.sample = bench.folder / "nowhere/knee";
  EXPECT_THAT(check().all(), Contains(wrong("sample", "does not exist: make it")));
}

TEST_F(RigCheck, LeavesTheDevicesToADaemonAtWork) {
  const SampleLock lock(bench.settings.plan.sample);
  parts.make_stage = []() -> std::shared_ptr<bridge::Stage> {
    ADD_FAILURE() << "asked the stage";
    return {};
  };
  const RigFindings findings = check();
  EXPECT_THAT(findings.all(), Contains(wrong("daemon", "a biotomyd works on this sample")));
  EXPECT_THAT(findings.all(), Contains(finding(Kind::good, "sample", "is new")));
  EXPECT_EQ(bench.camera.captures, 0);
}

TEST_F(RigCheck, LooksAtTheTokenWithoutMakingOne) {
  EXPECT_THAT(check().all(), Contains(finding(Kind::note, "token", "is made when the daemon")));
  std::ofstream(bench.folder / "token") << "short\n";
  std::filesystem::permissions(bench.folder / "token", std::filesystem::perms::owner_read);
  EXPECT_THAT(check().all(), Contains(wrong("token", "less than 16 characters")));
}

TEST_F(RigCheck, SaysThatCalibrationsCannotBeRecorded) {
  bench.settings.calibration.folder = bench.folder / "calibration";
  EXPECT_THAT(check().all(), Not(Contains(finding(Kind::note, "calibration", "none can be"))));
  std::ofstream(bench.folder / "file") << "in the way";
  bench.settings.calibration.folder = bench.folder / "file" / "calibration";
  EXPECT_THAT(check().all(), Contains(finding(Kind::note, "calibration", "none can be recorded")));
}

TEST_F(RigCheck, SaysThatThePageCannotBeWhereItIsToBe) {
  EXPECT_THAT(check().all(), Contains(finding(Kind::good, "page", "http://127.0.0.1:0")));
  configuration.service.host = "192.0.2.1";  // of no computer (RFC 5737)
  EXPECT_THAT(check().all(), Contains(wrong("page", "cannot listen on 192.0.2.1:0")));
}

TEST_F(RigCheck, LooksForTheProgramThatTellsPeople) {
  EXPECT_THAT(check().all(), Contains(finding(Kind::note, "notifications", "nobody is told")));
  configuration.notify.command = {"no-program-of-this-name"};
  configuration.notify.notifier.queue = bench.folder / "queue";
  EXPECT_THAT(check().all(), Contains(wrong("notifications", "there is no program")));
  configuration.notify.command = {"true"};
  EXPECT_THAT(check().all(), Contains(finding(Kind::good, "notifications", "by command")));
}

TEST_F(RigCheck, IsReadByPrograms) {
  bench.camera.gone = true;
  const std::string json = findings_json(check());
  EXPECT_THAT(json, HasSubstr("\"can_start\": false"));
  EXPECT_THAT(json, HasSubstr("\"part\": \"camera\",\n      \"kind\": \"wrong\",\n      "
                              "\"text\": \"camera: gone\""));
}

}  // namespace
}  // namespace biotomy::tests
