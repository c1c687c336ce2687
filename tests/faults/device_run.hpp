#pragma once

#include <chrono>
#include <filesystem>
#include <future>
#include <optional>
#include <string>

#include <nlohmann/json_fwd.hpp>

#include "tests/faults/killed_run.hpp"
#include "tests/faults/rig_bench.hpp"
#include "tests/faults/status_watch.hpp"

namespace biotomy::tests {

/// The plan of all runs with failing devices; `layers` of one are the first of another's.
RigPlan device_plan(int layers);

/// The sample of a run that nothing disturbed, of as many layers as any of the runs have. It is
/// made once, beside the first of them.
const std::filesystem::path& undisturbed_device_sample();
inline constexpr int kMostDeviceLayers = 48;

/// A job at work, whose devices can be broken.
class DeviceRun {
 public:
  explicit DeviceRun(const RigPlan& plan);

  KilledRun& job() { return job_; }
  SimulatedRig& rig() { return job_.rig(); }
  RigBench& bench() { return bench_; }
  StatusWatch& watch() { return watch_; }

  /// To be called with what is broken mended: goes on as an operator would, or waits, until another
  /// layer is committed than the `stopped` status had. Returns how long that took.
  std::chrono::milliseconds recover(const nlohmann::json& stopped);

 private:
  KilledRun job_;
  RigBench bench_;
  StatusWatch watch_;
};

/// ISO 8601, UTC.
std::string now_utc();

}  // namespace biotomy::tests
