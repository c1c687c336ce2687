#include "acquisition/job/preflight.hpp"

#include "acquisition/job/job_states.hpp"
#include "acquisition/job/preflight_complaints.hpp"
#include "acquisition/records/utc_time.hpp"
#include "acquisition/rig/capture.hpp"
#include "acquisition/rig/step_failure.hpp"

namespace biotomy::acquisition {
namespace {

/// Throws the first, if there is one.
template <typename Failure = StepFailure>
void refuse(const Complaints& complaints) {
  if (!complaints.empty()) throw Failure(complaints.front());
}

}  // namespace

void check_stage(const JobSettings& settings, const bridge::StageIdentity& stage) {
  refuse(stage_complaints(settings, stage));
}

PreflightFindings inspect(const JobSettings& settings, bridge::Camera& camera,
                          const Surroundings& surroundings) {
  PreflightFindings findings;
  camera.apply(settings.camera.settings);
  findings.camera = camera.describe();
  refuse(camera_complaints(settings, findings.camera));
  refuse(clock_complaints(surroundings.wall_clock(), ""));
  findings.records =
      std::make_shared<SampleRecords>(settings.plan, settings.store, findings.camera, surroundings);
  findings.journal = findings.records->summary();
  findings.disk_left_layers = findings.records->disk_left_layers();

  refuse(clock_complaints(surroundings.wall_clock(), findings.journal.last_event_at));
  findings.records->hold_constant(constants_of(settings.camera.settings, findings.camera));
  if (!findings.camera.correction.empty()) {
    findings.records->record_event({.kind = "recovery",
                                    .state = to_string(JobState::preflight),
                                    .text = "frames are corrected by " + findings.camera.correction,
                                    .at = utc_text(surroundings.wall_clock())});
  }
  // Once there are records, and whatever it shows: no frame is taken without one.
  const bridge::Frame trial = capture(camera, settings.camera.capture_time_out);
  findings.records->record_event({.kind = "recovery",
                                  .state = to_string(JobState::preflight),
                                  .text = "trial frame " + std::to_string(trial.sequence),
                                  .at = utc_text(surroundings.wall_clock())});
  refuse(frame_complaints(settings, findings.camera, trial));

  refuse<DiskFull>(
      disk_complaints(settings, findings.disk_left_layers, findings.journal.last_committed));
  findings.recalled = recall_faces(findings.records->sample(), findings.journal.last_committed,
                                   surroundings.read_layer);
  return findings;
}

}  // namespace biotomy::acquisition
