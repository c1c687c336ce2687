// The daemon on disks that fail: at each of its calls in turn, with each error, for once or until
// the disk is mended. The twin's witness log is the judge: no pass before the layer above was
// committed, no layer lost, and what the daemon says names the file and the reason. How many calls
// of each kind are made to fail is set by BIOTOMY_DISK_FAULTS (a number, or "all").

#include <algorithm>
#include <array>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <fstream>
#include <map>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include "tests/faults/fault.hpp"
#include "tests/faults/killed_run.hpp"

namespace biotomy::tests {
namespace {

namespace fs = std::filesystem;

using std::chrono::milliseconds;
using std::chrono::seconds;
using std::chrono::steady_clock;
using testing::AllOf;
using testing::AnyOf;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr seconds kPatience(120);

const RigPlan kPlan{.width = 80, .height = 64, .layers = 4, .time_scale = 400};

/// How a broken disk becomes sound again.
enum class Mending { in_place, with_a_new_daemon };

class DaemonOnAFaultyDisk : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    undisturbed_ = std::make_unique<KilledRun>(kPlan);
    const fs::path counts = undisturbed_->rig().folder() / "counts";
    undisturbed_->rig().launch_daemon(
        environment_of({.folder = undisturbed_->rig().sample()}, counts));
    undisturbed_->rig().await_daemon();
    undisturbed_->finish();
    undisturbed_->rig().send_daemon(SIGTERM);
    const Outcome end = undisturbed_->rig().await_daemon_end(kPatience);
    ASSERT_EQ(end.exit_code, 0) << end.errors;
    std::ifstream in(counts);
    for (std::string name; in >> name;) in >> calls_[name];
  }

  static void TearDownTestSuite() { undisturbed_.reset(); }

  /// Numbers from 1 to the count of such calls in an undisturbed job, spread.
  static std::vector<std::int64_t> numbers_of(const std::string& call, std::int64_t fallback) {
    const char* setting = std::getenv("BIOTOMY_DISK_FAULTS");
    const std::string text = setting != nullptr ? setting : std::to_string(fallback);
    const std::int64_t all = calls_.at(call);
    const std::int64_t count = text == "all" ? all : std::min<std::int64_t>(all, std::stoll(text));
    std::vector<std::int64_t> numbers;
    for (std::int64_t i = 0; i < count; ++i) {
      // Neither the first nor the last alone: what lies in the middle of a layer is of interest.
      numbers.push_back(1 + (2 * i + 1) * all / (2 * count));
    }
    return numbers;
  }

  /// Waits until the daemon stands still by an alarm, or has done the job all the same, or is gone.
  /// Returns the alarm's cause, or the words of a daemon that ended.
  static std::string await_alarm(KilledRun& run) {
    const auto deadline = steady_clock::now() + kPatience;
    while (steady_clock::now() < deadline) {
      if (const auto end = run.rig().daemon_end()) return end->errors;
      try {
        const nlohmann::json status = run.rig().status();
        if (status.at("state") == "done") return "";
        if (status.at("state") == "faulted" && status.at("alarm").is_object()) {
          return status.at("alarm").at("cause");
        }
      } catch (const std::runtime_error&) {
        // It ended between the two questions.
      }
      std::this_thread::sleep_for(milliseconds(5));
    }
    throw std::runtime_error("the daemon neither stopped nor did its job");
  }

  /// The reason is the system's own, or SQLite's word for it; a page that cannot be read may be a
  /// malformed one to it.
  static void expect_a_clear_sentence(const std::string& sentence, KilledRun& run,
                                      const std::string& reason) {
    EXPECT_THAT(sentence, AnyOf(HasSubstr("sample"), HasSubstr(run.rig().folder().string())));
    EXPECT_THAT(sentence, AnyOf(HasSubstr(reason), HasSubstr("disk I/O error"),
                                HasSubstr("database or disk is full"),
                                HasSubstr("unable to open database file"),
                                HasSubstr("database disk image is malformed"),
                                HasSubstr("attempt to write a readonly database")));
  }

  static std::string words_for(const std::string& error) {
    return error == "ENOSPC"  ? "No space left on device"
           : error == "EROFS" ? "Read-only file system"
                              : "Input/output error";
  }

  /// A job whose disk fails; mended once the daemon has stopped. Judged at its end.
  static void run_job(Fault fault, Mending mending) {
    KilledRun run(kPlan);
    fault.folder = run.rig().sample();
    fault.healed_by = run.rig().folder() / "healed";
    run.rig().launch_daemon(environment_of(fault));
    run.rig().await_daemon();
    const Outcome started = run.rig().rig("start");
    ASSERT_EQ(started.exit_code, 0) << started.errors;
    const std::string said = await_alarm(run);
    if (!said.empty()) expect_a_clear_sentence(said, run, words_for(fault.error));

    std::ofstream(fault.healed_by).flush();
    if (mending == Mending::with_a_new_daemon) run.rig().kill_daemon();
    // The frame that was on its way has no record: there was nothing to write it to. Before the
    // first frame there may be no journal to note it from.
    const bool stopped = !said.empty() || mending == Mending::with_a_new_daemon;
    if (stopped && !run.rig().witnessed("capture").empty()) run.note_kill();
    if (mending == Mending::with_a_new_daemon) run.rig().start_daemon();
    run.finish();
    if (said.empty()) make_volume_anew(run);
    EXPECT_THAT(run.verdict(undisturbed_->rig().sample()), IsEmpty());
  }

  /// A volume that could not be written stops nothing, as it can be made of the layers later.
  static void make_volume_anew(KilledRun& run) {
    run.rig().kill_daemon();
    const Outcome rebuilt =
        tests::run({BIOTOMY_TOOL, "rebuild", run.rig().sample()}, run.rig().folder(), kPatience);
    EXPECT_EQ(rebuilt.exit_code, 0) << rebuilt.errors;
  }

  static void fail_in_turn(const std::string& call) {
    constexpr std::array kErrors{"ENOSPC", "EIO", "EROFS"};
    constexpr std::array kMendings{Mending::in_place, Mending::with_a_new_daemon};
    std::size_t runs = 0;
    for (const std::int64_t at : numbers_of(call, 2)) {
      const std::string error = kErrors[runs % kErrors.size()];
      const bool once = runs % 4 == 1;
      SCOPED_TRACE(call + " " + std::to_string(at) + " of " + std::to_string(calls_.at(call)) +
                   " fails with " + error + (once ? ", once" : ""));
      run_job({.folder = {}, .call = call, .at = at, .times = once ? 1 : 0, .error = error},
              kMendings[runs % kMendings.size()]);
      if (HasFailure()) return;
      ++runs;
    }
    EXPECT_GT(runs, 0U);
  }

  static std::unique_ptr<KilledRun> undisturbed_;
  static std::map<std::string, std::int64_t> calls_;
};

std::unique_ptr<KilledRun> DaemonOnAFaultyDisk::undisturbed_;
std::map<std::string, std::int64_t> DaemonOnAFaultyDisk::calls_;

TEST_F(DaemonOnAFaultyDisk, LosesNoLayerWhenAFileCannotBeMade) {
  fail_in_turn("create");
}

TEST_F(DaemonOnAFaultyDisk, LosesNoLayerWhenAFolderCannotBeMade) {
  fail_in_turn("mkdir");
}

TEST_F(DaemonOnAFaultyDisk, LosesNoLayerWhenAWriteFails) {
  fail_in_turn("write");
}

TEST_F(DaemonOnAFaultyDisk, LosesNoLayerWhenASyncFails) {
  fail_in_turn("sync");
}

TEST_F(DaemonOnAFaultyDisk, LosesNoLayerWhenARenameFails) {
  fail_in_turn("rename");
}

TEST_F(DaemonOnAFaultyDisk, LosesNoLayerWhenAReadFails) {
  fail_in_turn("read");
}

TEST_F(DaemonOnAFaultyDisk, DoesItsJobByShortWrites) {
  run_job({.folder = {}, .most_bytes = 997}, Mending::in_place);
}

// The disk says how much is left, and the next layers would not fit.
TEST_F(DaemonOnAFaultyDisk, StopsBeforeTheWheelMovesWhenTheDiskIsFull) {
  KilledRun run(kPlan);
  const fs::path healed = run.rig().folder() / "healed";
  // As if nothing could be compressed, a layer and its part of the volume take 2 · 80 · 64 · 3
  // bytes; 20 layers are the reserve. The journal soon takes what is beyond.
  constexpr std::int64_t kSpace = 20 * 2 * 80 * 64 * 3 + 60'000;
  run.rig().launch_daemon(
      environment_of({.folder = run.rig().sample(), .space = kSpace, .healed_by = healed}));
  run.rig().await_daemon();
  ASSERT_EQ(run.rig().rig("start").exit_code, 0);
  const std::string said = await_alarm(run);
  EXPECT_THAT(said, AllOf(HasSubstr("the disk has room for 1"), HasSubstr("more layers")));
  EXPECT_EQ(static_cast<std::int64_t>(run.rig().witnessed("grind_pass").size()), run.committed());
  std::ofstream(healed).flush();
  run.finish();
  EXPECT_THAT(run.verdict(undisturbed_->rig().sample()), IsEmpty());
}

}  // namespace
}  // namespace biotomy::tests
