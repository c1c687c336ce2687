#pragma once

#include "tests/acquisition/fake_rig.hpp"
#include "tests/acquisition/job_bench.hpp"

namespace biotomy::tests {

/// A job bench whose worker, which has the disk and the camera, does nothing until a test says so.
struct HeldJobBench : JobBench {
  HeldWorker held;

  HeldJobBench() {
    job_worker = &held;
    start_daemon();
  }
  /// What is held back is released while the bench, which it may refer to, is still there.
  ~HeldJobBench() { job.reset(); }

  /// Ticks until the job is in the state, with all work done but what was posted in the last tick;
  /// false when it does not get there.
  bool reach(acquisition::JobState wanted) {
    for (int i = 0; i < 5000 && state() != wanted; ++i) {
      held.run();
      tick();
    }
    return state() == wanted;
  }
};

}  // namespace biotomy::tests
