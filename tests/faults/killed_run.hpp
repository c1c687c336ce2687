#pragma once

#include <chrono>
#include <string>
#include <vector>

#include "tests/faults/rig_operator.hpp"
#include "tests/faults/run_judge.hpp"
#include "tests/integration/simulated_rig.hpp"

namespace biotomy::tests {

/// The same job on a rig of its own that nobody disturbs: what each layer should look like. It runs
/// beside the test that disturbs the other.
class UndisturbedRun {
 public:
  explicit UndisturbedRun(const RigPlan& plan);

  /// Waits for its end.
  std::filesystem::path sample();

 private:
  SimulatedRig rig_;
};

/// A job that is killed and gone on with, and judged at its end.
class KilledRun {
 public:
  explicit KilledRun(const RigPlan& plan);

  SimulatedRig& rig() { return rig_; }

  /// Starts the daemon and goes on with the job; kills the daemon `time` after its launch, or after
  /// it is at work. Throws std::runtime_error when it ends by itself before.
  enum class From { launch, work };
  void run_daemon_for(From from, std::chrono::microseconds time);

  /// Starts the daemon so that it is killed at a point (see killing_point.hpp), and goes on with
  /// the job until it is.
  void run_daemon_to(const std::string& point);

  /// To be called while what was killed is not running yet again.
  void note_kill();

  /// Starts the daemon unless it runs, and does what an operator does with a rig that stands still:
  /// acknowledges, starts, resumes; until it is at its steps again or done. Throws
  /// std::runtime_error when it will not go on.
  void go_on();

  /// Goes on with the job to its end, however often it stops.
  void finish();

  /// Layers that the journal holds as committed.
  std::int64_t committed() const;

  /// The causes of the alarms that `go_on` acknowledged.
  const std::vector<std::string>& alarms() const { return operator_.alarms(); }

  /// What was wrong with the run, by `judge`, by `biotomy verify`, and by hidden files that killed
  /// daemons left in the sample.
  std::vector<std::string> verdict(const std::filesystem::path& undisturbed_sample);

 private:
  void await_kill(bool go_on_meanwhile);

  SimulatedRig rig_;
  RigOperator operator_;
  std::vector<Killed> kills_;
};

}  // namespace biotomy::tests
