#include "acquisition/job/step_alarm.hpp"

#include "acquisition/records/journal_error.hpp"
#include "acquisition/rig/step_failure.hpp"
#include "reconstruct/errors.hpp"

namespace biotomy::acquisition {

AlarmKind alarm_kind_of(const std::exception& error, JobState state) {
  const auto* failure = dynamic_cast<const StepFailure*>(&error);
  if (failure != nullptr && failure->kind()) return *failure->kind();
  const bool is_of_the_disk = dynamic_cast<const JournalError*>(&error) != nullptr ||
                              dynamic_cast<const reconstruct::SampleError*>(&error) != nullptr;
  if (is_of_the_disk && state != JobState::preflight) return AlarmKind::storage;
  switch (state) {
    case JobState::preflight:
      return AlarmKind::preflight;
    case JobState::recovering:
      return AlarmKind::disagreement;
    case JobState::conditioning:
    case JobState::held:
      return AlarmKind::temperature;
    case JobState::focusing:
      return AlarmKind::focus;
    case JobState::capturing:
    case JobState::lighting:
      return AlarmKind::camera;
    case JobState::assessing:
    case JobState::storing:
      return AlarmKind::storage;
    case JobState::resetting:
      return AlarmKind::controller;
    default:
      return AlarmKind::motion;
  }
}

}  // namespace biotomy::acquisition
