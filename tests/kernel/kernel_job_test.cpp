// Jobs of a daemon whose camera, lines and serial line are a kernel's own; only the rig is
// simulated.
#include <chrono>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <iostream>
#include <random>
#include <string>
#include <thread>

#include <gmock/gmock.h>

#include "acquisition/records/utc_time.hpp"
#include "tests/faults/killed_run.hpp"
#include "tests/kernel/kernel_plan.hpp"
#include "tests/kernel/machine.hpp"
#include "tests/kernel/remote_rig.hpp"

namespace biotomy::tests {
namespace {

namespace fs = std::filesystem;
using std::chrono::milliseconds;
using std::chrono::seconds;
using testing::IsEmpty;

constexpr int kLayers = 24;
constexpr int kCuts = 4;

/// Where the machine leaves what it has to say.
fs::path results(const std::string& name) {
  const char* folder = std::getenv("BIOTOMY_KERNEL_RESULTS");
  if (folder == nullptr) throw std::runtime_error("BIOTOMY_KERNEL_RESULTS is not set");
  return fs::absolute(fs::path(folder) / name);
}

unsigned chosen_seed() {
  const char* text = std::getenv("BIOTOMY_CUT_SEED");
  return text != nullptr ? static_cast<unsigned>(std::atoi(text)) : std::random_device()();
}

class KernelJob : public testing::Test {
 protected:
  /// Of the same specimen, by the twin's own camera.
  static const fs::path& undisturbed() {
    static RigPlan plan = [] {
      RigPlan same = kernel_plan(kLayers);
      same.listen = RigPlan().listen;
      same.twin_stage_settings = kPatientController;
      same.daemon_stage_settings = "";
      return same;
    }();
    static UndisturbedRun run(plan);
    static const fs::path sample = run.sample();
    return sample;
  }

  /// What was wrong with the job whose sample is at `sample`, at last.
  std::vector<std::string> verdict(const fs::path& sample, const std::vector<Killed>& kills) {
    SimulatedRig& rig = remote_.rig();
    std::vector<std::string> complaints = judge({.witness = rig.witness(),
                                                 .sample = sample,
                                                 .layers = kLayers,
                                                 .first_face_um = plan_.first_face_um,
                                                 .layer_thickness_um = plan_.layer_thickness_um,
                                                 .kills = kills,
                                                 .camera_streams = true},
                                                undisturbed());
    const Outcome verified = run({BIOTOMY_TOOL, "verify", sample}, rig.folder(), seconds(60));
    if (verified.exit_code != 0) complaints.push_back(verified.output + verified.errors);
    return complaints;
  }

  const RigPlan plan_ = kernel_plan(kLayers);
  RemoteRig remote_{plan_};
};

TEST_F(KernelJob, LeavesTheStackOfAnUndisturbedRun) {
  const fs::path folder = results("job");
  Machine machine(folder, remote_.plugged_in(folder),
                  {BIOTOMY_KERNEL_JOB, folder / "run", std::to_string(kLayers)});
  const Outcome end = machine.wait(seconds(240));
  ASSERT_EQ(end.exit_code, 0) << end.output << end.errors;
  EXPECT_THAT(verdict(folder / "run/sample", {}), IsEmpty());
}

class DisturbedJob : public KernelJob {};

TEST_F(DisturbedJob, StopsAndGoesOnAndLeavesTheStackOfAnUndisturbedRun) {
  const fs::path folder = results("disturbed");
  Machine machine(folder, remote_.plugged_in(folder),
                  {BIOTOMY_KERNEL_DISTURBANCES, folder / "run", std::to_string(kLayers)});
  const Outcome end = machine.wait(seconds(360));
  std::cout << end.output << std::endl;
  ASSERT_EQ(end.exit_code, 0) << end.errors;
  EXPECT_THAT(verdict(folder / "run/sample", {}), IsEmpty());
}

/// A machine whose power is cut over and over, and what its disk keeps.
class PowerCuts : public KernelJob {
 protected:
  PowerCuts() {
    fs::create_directories(folder_);
    const Outcome made =
        run({"/usr/sbin/mke2fs", "-q", "-F", "-t", "ext4", disk_, "128M"}, folder_);
    if (made.exit_code != 0) throw std::runtime_error(made.errors);
  }

  Machine boot() {
    std::vector<std::string> options = remote_.plugged_in(folder_);
    options.push_back("ubd0=" + disk_.string());
    // The disk is the machine's alone: what has come of the job is read from a copy.
    return Machine(folder_, options,
                   {"/bin/bash", "-c",
                    std::string(BIOTOMY_KERNEL_JOB) + " /run/disk/run " + std::to_string(kLayers) +
                        " && cp -r /run/disk/run/sample " + copy_.string()});
  }

  /// Layers that the journal held as the machine came up.
  static std::int64_t found(Machine& machine) {
    return std::stoll(machine.wait_for("found ", seconds(60)));
  }

  /// So many layers of the job, or more.
  static void await_committed(Machine& machine, std::int64_t layers) {
    machine.wait_for("committed ", seconds(120));
    const auto deadline = std::chrono::steady_clock::now() + seconds(120);
    while (machine.last_number_after("committed ") < layers && !machine.end() &&
           std::chrono::steady_clock::now() < deadline) {
      std::this_thread::sleep_for(milliseconds(10));
    }
  }

  const fs::path folder_ = results("power");
  const fs::path disk_ = folder_ / "disk.image";
  const fs::path copy_ = folder_ / "sample";
};

TEST_F(PowerCuts, LoseNothingThatWasCommitted) {
  const unsigned seed = chosen_seed();
  std::cout << "BIOTOMY_CUT_SEED=" << seed << std::endl;
  std::mt19937 random(seed);
  std::vector<Killed> kills;
  std::int64_t told = 0;
  for (int cut = 0; cut < kCuts; ++cut) {
    Machine machine = boot();
    const std::int64_t held = found(machine);
    if (!kills.empty()) kills.back().committed = held;
    EXPECT_GE(held, told) << "cut " << cut;
    await_committed(machine, held + std::uniform_int_distribution<int>(0, 3)(random));
    std::this_thread::sleep_for(milliseconds(std::uniform_int_distribution<int>(0, 2000)(random)));
    ASSERT_FALSE(machine.end()) << "the job was over before cut " << cut;
    machine.cut_power();
    kills.push_back({.at = acquisition::utc_text(std::chrono::system_clock::now())});
    told = machine.last_number_after("committed ");
    std::cout << "cut " << cut + 1 << ": the journal held " << held << " layers as it came up, "
              << told << " were told of as it went down" << std::endl;
  }
  Machine machine = boot();
  kills.back().committed = found(machine);
  EXPECT_GE(kills.back().committed, told);
  EXPECT_GT(kills.back().committed, 0);
  const Outcome end = machine.wait(seconds(240));
  ASSERT_EQ(end.exit_code, 0) << end.output << end.errors;
  EXPECT_THAT(verdict(copy_, kills), IsEmpty());
}

}  // namespace
}  // namespace biotomy::tests
