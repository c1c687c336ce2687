#pragma once

#include <cstdint>
#include <future>
#include <optional>
#include <string>

#include "acquisition/focus/autofocus.hpp"
#include "acquisition/focus/focus_memory.hpp"
#include "acquisition/job/job_settings.hpp"
#include "acquisition/job/stage_commands.hpp"
#include "acquisition/job/worker.hpp"
#include "acquisition/records/record_keeper.hpp"
#include "firmware_bridge/camera/camera.hpp"

namespace biotomy::acquisition {

/// Brings the column to where the face is sharp: by following the face, or by a search. A search
/// without a peak is fatal only when nothing is known of the focus; otherwise the column follows
/// and the assessment judges.
class FocusStep {
 public:
  FocusStep(const JobSettings& settings, bridge::AxisLimits column, FocusMemory& memory,
            StageCommands& commands, bridge::Camera& camera, Worker& worker, RecordKeeper& keeper);

  /// `why_search` null: only follow.
  void begin(std::int64_t layer, const char* why_search, TimePoint now);

  /// True when the column is at the focus. Throws StepFailure, and what the camera throws.
  bool poll(const bridge::StageStatus& status, TimePoint now);

  std::string waiting_for() const;

 private:
  void move_to(bridge::Micrometres column, TimePoint now);
  void ask_next(TimePoint now);
  void end_search(TimePoint now);

  enum class Phase { move_in_search, measure, take_up_backlash, move_to_focus };

  const JobSettings& settings_;
  bridge::AxisLimits column_;
  FocusMemory& memory_;
  StageCommands& commands_;
  bridge::Camera& camera_;
  Worker& worker_;
  RecordKeeper& keeper_;

  std::int64_t layer_ = 0;
  std::string why_;
  std::optional<Autofocus> search_;
  Phase phase_ = Phase::move_to_focus;
  bridge::Micrometres target_{};
  bridge::Micrometres focus_{};
  std::future<double> sharpness_;
};

}  // namespace biotomy::acquisition
