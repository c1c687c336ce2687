// The power of the whole machine is cut, after each call that a daemon makes to the disk: a job on
// the twin is run once with its disk recorded, and what the disk may hold after each call is opened
// as a daemon would. BIOTOMY_POWER_CUT_ROUNDS: how often with what is lost by chance.

#include "tests/faults/power_cut.hpp"

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include "tests/faults/fault.hpp"
#include "tests/faults/killed_run.hpp"

namespace biotomy::tests {
namespace {

using std::chrono::seconds;
using testing::IsEmpty;

constexpr seconds kLongestJob(200);
/// Where the daemon is killed, not the power cut: in the middle of the run.
constexpr const char* kKilled = "before rename */layers/000004.tif";

/// The recorded run, of which all tests look at copies.
class PowerCut : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    rig_ = std::make_unique<SimulatedRig>(
        RigPlan{.width = 80,
                .height = 64,
                .layers = 7,
                .daemon_settings = "[store]\nchunk = [32, 32, 2]\nshard = [64, 64, 2]\n"});
    const std::filesystem::path log = rig_->folder() / "disk.log";
    const auto start = [&](const std::vector<std::string>& environment) {
      rig_->launch_daemon(environment);
      rig_->await_daemon();
      const Outcome started = rig_->rig("start");
      ASSERT_EQ(started.exit_code, 0) << started.errors;
    };
    // What it had not synced is not lost by that, and may be later.
    start(recorded_and_killed(*rig_, log, kKilled));
    ASSERT_EQ(rig_->await_daemon_end(kLongestJob).exit_code, 128 + SIGKILL);
    start(recorded(*rig_, log));
    const Outcome watched = rig_->rig("watch", kLongestJob);
    ASSERT_EQ(watched.exit_code, 0) << watched.output << watched.errors;
    ASSERT_EQ(rig_->end_daemon().exit_code, 0);  // at the end of its log
    cuts_ = std::make_unique<PowerCuts>(*rig_, RecordedDisk(log));
  }

  static void TearDownTestSuite() {
    cuts_.reset();
    rig_.reset();
  }

  void SetUp() override { ASSERT_NE(cuts_, nullptr) << "the run could not be recorded"; }

  static std::size_t calls() { return cuts_->disk().calls().size(); }

  /// The environment in which a daemon's disk is recorded.
  static std::vector<std::string> recorded(const SimulatedRig& rig,
                                           const std::filesystem::path& log) {
    return {"LD_PRELOAD=" BIOTOMY_DISK_RECORDER, "BIOTOMY_RECORD_FOLDER=" + rig.sample().string(),
            "BIOTOMY_RECORD_LOG=" + log.string()};
  }

  /// And in which it is killed at a point, between two calls.
  static std::vector<std::string> recorded_and_killed(const SimulatedRig& rig,
                                                      const std::filesystem::path& log,
                                                      const std::string& point) {
    std::vector<std::string> environment = recorded(rig, log);
    environment.front() = "LD_PRELOAD=" BIOTOMY_KILLING_POINT " " BIOTOMY_DISK_RECORDER;
    environment.push_back("BIOTOMY_KILLING_POINT=" + point);
    return environment;
  }

  /// Cuts the power after each call.
  static void expect_no_complaints(PowerLoss loss, unsigned seed = 0) {
    std::mt19937 random(seed);
    for (std::size_t cut = 0; cut <= calls(); ++cut) {
      ASSERT_THAT(cuts_->complaints(cut, loss, random), IsEmpty())
          << "after call " << cut << " of " << calls() << ", on "
          << (cut == 0 ? "" : cuts_->disk().calls()[cut - 1].path) << ", seed " << seed;
    }
  }

  /// The last sync of a file like that before the grind of the layer was sent.
  static std::size_t sync_before_grind(const std::string& path, std::int64_t layer) {
    for (std::size_t call = cuts_->call_before_grind(layer);; --call) {
      const RecordedDisk::Call& made = cuts_->disk().calls().at(call);
      if (made.kind == DiskCall::sync && made.path.starts_with(path) &&
          (made.path == path || path.back() == '.')) {
        return call;
      }
    }
  }

  static void await_state(SimulatedRig& rig, const std::string& state) {
    const auto deadline = std::chrono::steady_clock::now() + kLongestJob;
    while (rig.status().at("state") != state) {
      ASSERT_LT(std::chrono::steady_clock::now(), deadline) << rig.status().dump(1);
    }
  }

  /// Which sync of the program it is, from 1.
  static std::int64_t count_syncs_to(std::size_t call) {
    const auto& calls = cuts_->disk().calls();
    return std::count_if(
        calls.begin(), calls.begin() + static_cast<std::ptrdiff_t>(call) + 1,
        [](const RecordedDisk::Call& made) { return made.kind == DiskCall::sync; });
  }

  /// The first complaints that there are without the sync, wherever the power is cut afterwards.
  static std::vector<std::string> complaints_without(std::size_t sync) {
    const PowerCuts cuts = cuts_->without_sync(sync);
    std::mt19937 random(42);
    for (std::size_t cut = sync + 1; cut <= calls(); ++cut) {
      std::vector<std::string> complaints = cuts.complaints(cut, PowerLoss::everything, random);
      if (!complaints.empty()) return complaints;
    }
    return {};
  }

  static std::unique_ptr<SimulatedRig> rig_;
  static std::unique_ptr<PowerCuts> cuts_;
};

std::unique_ptr<SimulatedRig> PowerCut::rig_;
std::unique_ptr<PowerCuts> PowerCut::cuts_;

TEST_F(PowerCut, LosesNothingThatWasCommittedWhenOnlyWhatWasSyncedStays) {
  expect_no_complaints(PowerLoss::everything);
}

TEST_F(PowerCut, LosesNothingThatWasCommittedWhenNamesStayWithoutTheirData) {
  expect_no_complaints(PowerLoss::data);
}

TEST_F(PowerCut, LosesNothingThatWasCommittedWhateverStays) {
  const char* rounds = std::getenv("BIOTOMY_POWER_CUT_ROUNDS");
  for (unsigned seed = 1; seed <= (rounds != nullptr ? std::stoul(rounds) : 2); ++seed) {
    expect_no_complaints(PowerLoss::random, seed);
    if (HasFatalFailure()) return;
  }
}

TEST_F(PowerCut, LosesNothingWhenTheDaemonAloneIsKilled) {
  expect_no_complaints(PowerLoss::nothing);
}

// Syncs fail until the daemon, which has stopped, is killed and started again on a disk that was
// mended; later the power is cut. What the page cache took for written must not be believed by
// then.
TEST_F(PowerCut, LosesNothingThatWasCommittedAfterSyncsHadFailed) {
  std::mt19937 random(42);
  const auto number = count_syncs_to(sync_before_grind("journal.sqlite-wal", 3));
  // The intent of the grind, the records before it, and the image of the layer above.
  for (const std::int64_t back : {0, 1, 2, 4}) {
    SCOPED_TRACE("syncs fail from number " + std::to_string(number - back) + " on");
    KilledRun run(rig_->plan());
    const std::filesystem::path log = run.rig().folder() / "disk.log";
    const std::filesystem::path healed = run.rig().folder() / "healed";
    std::vector<std::string> environment = environment_of({.folder = run.rig().sample(),
                                                           .call = "sync",
                                                           .at = number - back,
                                                           .error = "EIO",
                                                           .healed_by = healed});
    const std::vector<std::string> recording = recorded(run.rig(), log);
    environment.insert(environment.end(), recording.begin(), recording.end());
    environment.emplace_back("LD_PRELOAD=" BIOTOMY_DISK_RECORDER " " BIOTOMY_FAULTY_DISK);
    run.rig().launch_daemon(environment);
    run.rig().await_daemon();
    run.go_on();
    await_state(run.rig(), "faulted");
    run.rig().kill_daemon();
    std::ofstream(healed).flush();
    run.rig().launch_daemon(environment);
    run.rig().await_daemon();
    run.finish();

    const PowerCuts cuts(run.rig(), RecordedDisk(log));
    const auto& calls = cuts.disk().calls();
    EXPECT_TRUE(std::any_of(calls.begin(), calls.end(), [](const RecordedDisk::Call& call) {
      return call.kind == DiskCall::failed_sync;
    }));
    for (std::size_t cut = 0; cut <= calls.size(); ++cut) {
      ASSERT_THAT(cuts.complaints(cut, PowerLoss::everything, random, PowerCuts::Volume::lost),
                  IsEmpty())
          << "after call " << cut << " of " << calls.size();
    }
  }
}

TEST_F(PowerCut, LosesNoFolderThatAKilledDaemonHadMadeAndNotSynced) {
  // The volume's own folder, and one that is made with its first shard.
  for (const std::string folder : {"*/volume.ome.zarr", "*/volume.ome.zarr/0/c"}) {
    SCOPED_TRACE("killed before it synced " + folder);
    KilledRun run(rig_->plan());
    const std::filesystem::path log = run.rig().folder() / "disk.log";
    run.rig().launch_daemon(recorded_and_killed(run.rig(), log, "before sync " + folder));
    run.rig().await_daemon();
    const Outcome started = run.rig().rig("start");
    ASSERT_EQ(started.exit_code, 0) << started.errors;
    ASSERT_EQ(run.rig().await_daemon_end(kLongestJob).exit_code, 128 + SIGKILL);
    run.rig().launch_daemon(recorded(run.rig(), log));
    run.rig().await_daemon();
    run.finish();
    ASSERT_EQ(run.rig().end_daemon().exit_code, 0);  // at the end of its log

    const PowerCuts cuts(run.rig(), RecordedDisk(log));
    std::mt19937 random(42);
    for (std::size_t cut = 0; cut <= cuts.disk().calls().size(); ++cut) {
      ASSERT_THAT(cuts.complaints(cut, PowerLoss::everything, random), IsEmpty())
          << "after call " << cut << " of " << cuts.disk().calls().size();
    }
  }
}

TEST_F(PowerCut, IsNoticedWhenALayersFileWasNotSynced) {
  for (const std::int64_t layer : {2, 5}) {
    const std::string file = "layers/.00000" + std::to_string(layer) + ".tif.";
    EXPECT_THAT(complaints_without(sync_before_grind(file, layer + 1)), testing::Not(IsEmpty()))
        << layer;
  }
}

TEST_F(PowerCut, IsNoticedWhenTheLayersFolderWasNotSynced) {
  EXPECT_THAT(complaints_without(sync_before_grind("layers", 3)), testing::Not(IsEmpty()));
}

TEST_F(PowerCut, IsNoticedWhenTheIntentOfAGrindWasNotSynced) {
  for (const std::int64_t layer : {3, 6}) {
    EXPECT_THAT(complaints_without(sync_before_grind("journal.sqlite-wal", layer)),
                testing::Not(IsEmpty()))
        << layer;
  }
}

}  // namespace
}  // namespace biotomy::tests
