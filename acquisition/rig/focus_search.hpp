#pragma once

#include <functional>
#include <future>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "acquisition/focus/autofocus.hpp"
#include "acquisition/focus/face_lean.hpp"
#include "acquisition/focus/focus_actuator.hpp"
#include "acquisition/records/journal_rows.hpp"
#include "acquisition/rig/step_failure.hpp"
#include "acquisition/settings/job_settings.hpp"
#include "acquisition/worker.hpp"
#include "firmware_bridge/camera/camera.hpp"

namespace biotomy::acquisition {

/// What a search for the focus works with. All outlive it; the camera belongs to the worker's
/// thread.
struct SearchParts {
  FocusActuator& actuator;
  bridge::Camera& camera;
  Worker& worker;
};

/// One search for the focus, as Autofocus thinks of it: goes where it wants to look and takes the
/// frames. Moved on by `poll`, which does not block.
class FocusSearch {
 public:
  /// Sets out at once, for the predicted position or the next one within the actuator's limits.
  /// `settings` outlive it. Throws what the actuator throws.
  FocusSearch(const JobSettings& settings, SearchPlan plan, const SearchParts& parts,
              TimePoint now);

  /// True once it has ended. Throws what the actuator and the camera throw.
  bool poll(const bridge::StageStatus& status, TimePoint now);

  bridge::Micrometres predicted() const { return plan_.predicted; }
  bridge::Micrometres stands_at() const { return stands_at_; }
  const std::vector<FocusRow::Point>& points() const { return points_; }
  bool waits_for_frame() const { return measured_.valid(); }
  bool has_ended() const { return !autofocus_.next(); }

  /// Breaks the search off. Gives what the frame under way will measure, if one is: it waits for
  /// it, and gives nothing when the frame could not be taken.
  std::function<std::optional<FocusRow::Point>()> break_off();

  /// After the end, as Autofocus gives them. The actuator stands where the focus was found.
  const std::optional<Autofocus::Found>& found() const { return autofocus_.found(); }
  const std::string& why_not() const { return autofocus_.why_not(); }

  /// How the face leans that was found, where enough of it shows detail.
  std::optional<FaceLean> lean() const;

 private:
  bool ask_next(TimePoint now);
  void take_frame(const bridge::StageStatus& status);
  void take_measures();

  const JobSettings& settings_;
  SearchPlan plan_;
  SearchParts parts_;
  TimePoint begun_;
  Autofocus autofocus_;
  bridge::Micrometres stands_at_{};
  bridge::Micrometres measured_at_{};
  std::vector<FocusRow::Point> points_;
  std::future<std::shared_ptr<const FrameMeasures>> measured_;
};

}  // namespace biotomy::acquisition
