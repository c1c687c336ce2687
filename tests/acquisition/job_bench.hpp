#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "acquisition/job/job.hpp"
#include "tests/acquisition/fake_rig.hpp"
#include "tests/temporary_folder.hpp"

namespace biotomy::tests {

/// A job on a fake rig with a clock that only ticks. The sample lies in a folder of its own; the
/// layer images are not really written unless a test says so.
struct JobBench {
  TemporaryFolder folder;
  FakeStage stage;
  FakeLines lines;
  FakeCamera camera{stage};
  acquisition::WatchedCamera watched_camera{camera, [this] { return surroundings.wall_clock(); }};
  bridge::Camera* plain_camera = nullptr;  ///< as in JobParts
  InlineWorker worker;
  acquisition::Worker* job_worker = &worker;  ///< the one that a job is given
  InlineWorker volume_worker;
  InlineWorker event_worker;
  acquisition::OperatorDesk desk;
  acquisition::StatusBoard board;
  acquisition::JobSettings settings;
  acquisition::Surroundings surroundings;

  std::uintmax_t free_bytes = std::uintmax_t{1} << 40U;
  std::string store_failure;                        ///< not empty: writing a layer fails with this
  int prepared = 0;                                 ///< layers, stored in the end or not
  int released_by_control = 0;                      ///< of these, not by the worker
  std::weak_ptr<int> last_prepared;                 ///< expired once it is published or given up
  std::vector<std::string> written;                 ///< names of the layer files, in order
  std::map<std::filesystem::path, cv::Mat> images;  ///< what these show
  std::int64_t in_volume = 0;
  bool volume_finished = false;

  std::unique_ptr<acquisition::Job> job;
  std::chrono::steady_clock::time_point now{};
  std::chrono::system_clock::time_point wall_clock_start =
      std::chrono::sys_days(std::chrono::year(2026) / 11 / 1);

  JobBench();

  /// The daemon starts (again): a new job object on the same rig and sample.
  void start_daemon();

  void tick(int times = 1);

  /// Ticks until the job is in the state; false when it does not get there.
  bool reach(acquisition::JobState state, int ticks = 5000);

  /// Likewise, until so many layers are committed.
  bool reach_committed(std::int64_t layers, int ticks = 5000);

  /// Lays the command down, ticks until it is answered.
  acquisition::OperatorReply say(acquisition::OperatorCommand command);

  /// From the daemon's start to the job's first step.
  void start_job();

  acquisition::JobState state() const { return job->state(); }
  std::string alarm() const;
  std::string events_of_kind(const std::string& kind) const;
  std::int64_t count_rows(const std::string& table, const std::string& where = "1") const;
};

}  // namespace biotomy::tests
