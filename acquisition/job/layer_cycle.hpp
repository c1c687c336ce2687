#pragma once

#include <cstdint>
#include <future>
#include <memory>
#include <optional>
#include <string>

#include "acquisition/focus/focus_memory.hpp"
#include "acquisition/job/assessed_frame.hpp"
#include "acquisition/job/focus_step.hpp"
#include "acquisition/job/grind_step.hpp"
#include "acquisition/job/job_states.hpp"
#include "acquisition/job/judged_attempt.hpp"
#include "acquisition/records/recalled_faces.hpp"
#include "acquisition/records/record_keeper.hpp"
#include "acquisition/records/volume_feed.hpp"
#include "acquisition/rig/retraction.hpp"
#include "acquisition/rig/stage_commands.hpp"
#include "acquisition/settings/job_settings.hpp"
#include "acquisition/worker.hpp"
#include "firmware_bridge/camera/camera.hpp"
#include "firmware_bridge/lines/lines.hpp"

namespace biotomy::acquisition {

/// What a layer cycle works with. All outlive it.
struct CycleParts {
  StageCommands& commands;
  bridge::Lines& lines;
  bridge::Camera& camera;
  Worker& worker;
  RecordKeeper& keeper;
  VolumeFeed& feed;
};

/// What a layer cycle starts from.
struct CycleStart {
  JournalSummary journal;
  bridge::AxisLimits column;
  bridge::CameraDescription camera;
  std::int64_t disk_left_layers = 0;
  RecalledFaces recalled{};
};

/// The last layer that was committed, for the status.
struct CommittedLayer {
  std::int64_t layer = 0;
  int attempt = 0;
  Assessment assessment;
};

/// The steps of a layer, from `grinding` to `storing`. Each is begun and then polled at every tick;
/// nothing in it blocks. What goes wrong comes out of `begin` and `poll` as an exception whose
/// message is the alarm's cause.
class LayerCycle {
 public:
  LayerCycle(const JobSettings& settings, const CycleParts& parts, const CycleStart& start);

  void begin(JobState step, const bridge::StageStatus& status, TimePoint now);
  std::optional<JobEvent> poll(JobState step, const bridge::StageStatus& status, TimePoint now);

  /// The step is over before its end. A frame in hand, or on its way, still gets its record.
  void abandon(const std::string& why);

  std::string waiting_for(JobState step) const;

  /// After `attempts_exhausted`: why the layer has no frame, and what to do.
  std::string why_exhausted() const;

  std::int64_t layer() const { return layer_; }  ///< the one in work
  int attempt() const { return attempt_; }       ///< of it; 0 before its first frame
  std::int64_t disk_left_layers() const { return disk_left_layers_; }
  const std::optional<CommittedLayer>& last_committed() const { return last_committed_; }
  const std::optional<JudgedAttempt>& last_judged() const { return last_judged_; }
  const std::optional<FocusReport>& last_focus() const { return focus_.last_search(); }

 private:
  struct Stored {
    std::uint64_t bytes = 0;
    std::int64_t disk_left_layers = 0;
  };

  void begin_capture(const bridge::StageStatus& status);
  void begin_assessment();
  void begin_storing();
  std::optional<JobEvent> judge();
  bool may_flag() const;
  std::string why_not_flagged() const;
  void remember_judgement();
  std::optional<JobEvent> layer_stored();
  void reject(const JudgedFrame& frame);
  template <typename Prepared>
  void give_up(Prepared prepared);

  const JobSettings& settings_;
  CycleParts parts_;
  FrameExpectation expectation_;
  FocusMemory focus_memory_;
  GrindStep grind_;
  Retraction retraction_;
  FocusStep focus_;

  std::int64_t layer_;
  int attempt_;                 ///< as journalled: goes on counting after a restart
  int climbed_ = 0;             ///< attempts since the ladder was begun
  int unchanged_ = 0;           ///< of these, the last so many found the face of the layer before
  std::string last_rejection_;  ///< why the last frame that was rejected was not good enough
  bool lacks_only_sharpness_ = false;  ///< that frame
  int flagged_in_a_row_;               ///< layers, up to the last committed one
  bool focus_again_ = false;
  std::int64_t disk_left_layers_;
  TimePoint step_begin_{};

  std::future<JudgedFrame> capture_;
  std::shared_ptr<JudgedFrame> in_hand_;
  std::shared_ptr<JudgedFrame> best_rejected_;
  std::optional<FocusMemory> focus_of_best_;  ///< what was known of the focus when it was taken
  std::future<AssessedFrame> assessment_;
  std::future<Stored> stored_;
  std::optional<CommittedLayer> last_committed_;
  std::optional<JudgedAttempt> last_judged_;
};

}  // namespace biotomy::acquisition
