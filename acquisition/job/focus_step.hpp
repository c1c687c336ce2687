#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "acquisition/focus/focus_actuator.hpp"
#include "acquisition/focus/focus_memory.hpp"
#include "acquisition/job/focus_report.hpp"
#include "acquisition/quality/assessment.hpp"
#include "acquisition/records/record_keeper.hpp"
#include "acquisition/rig/focus_search.hpp"
#include "acquisition/rig/step_failure.hpp"
#include "acquisition/settings/job_settings.hpp"
#include "acquisition/worker.hpp"
#include "firmware_bridge/camera/camera.hpp"

namespace biotomy::acquisition {

/// Why a layer's focus is searched.
struct SearchReason {
  const char* words = nullptr;  ///< null: it is only followed
  bool anywhere = false;        ///< what was remembered is in doubt
};

/// Brings the face into focus: by following it, or by a search. A search without a peak is fatal
/// only when nothing is known of the focus; otherwise the actuator follows and the assessment
/// judges.
class FocusStep {
 public:
  FocusStep(const JobSettings& settings, std::unique_ptr<FocusActuator> actuator,
            FocusMemory& memory, bridge::Camera& camera, Worker& worker, RecordKeeper& keeper);

  /// `noise` is the camera's, where it is known.
  void begin(std::int64_t layer, SearchReason reason, const std::optional<CameraNoise>& noise,
             TimePoint now);

  /// True when the face is in focus. Throws StepFailure, and what the devices throw.
  bool poll(const bridge::StageStatus& status, TimePoint now);

  /// The step is over before its end. A search that is under way still gets its record.
  void abandon(const std::string& why);

  std::string waiting_for() const;

  /// Once the face is in focus, "focus_change": how far that is from where it was expected, in µm
  /// for each layer since the last search, and how far a search is believed. Nothing for a first
  /// layer, which expects nothing.
  std::optional<Metric> change() const;

  const std::optional<FocusReport>& last_search() const { return last_search_; }

 private:
  void move_to(bridge::Micrometres target, TimePoint now);
  void approach(bridge::Micrometres target, TimePoint now);
  void end_search(TimePoint now);
  void report();

  enum class Phase { search, take_up_backlash, move_to_focus, in_focus };

  const JobSettings& settings_;
  std::unique_ptr<FocusActuator> actuator_;
  FocusMemory& memory_;
  bridge::Camera& camera_;
  Worker& worker_;
  RecordKeeper& keeper_;

  std::int64_t layer_ = 0;
  const char* why_ = nullptr;  ///< it is searched
  std::optional<FocusSearch> search_;
  Phase phase_ = Phase::move_to_focus;
  bridge::Micrometres focus_{};
  std::optional<SearchPlan> expected_;  ///< what was known of the layer's focus beforehand
  std::optional<bridge::Micrometres> stands_at_;
  std::optional<FocusReport> last_search_;
};

}  // namespace biotomy::acquisition
