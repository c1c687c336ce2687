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

void check_clock(SampleRecords& records, const std::string& last_event_at,
                 std::chrono::system_clock::time_point clock, const std::string& wrong_record) {
  const Complaints complaints = clock_complaints(clock, last_event_at);
  if (complaints.empty()) return;
  if (last_event_at != wrong_record) throw ClockBehind(complaints.front(), last_event_at);
  // From now on this is the last record.
  records.record_event({.kind = "recovery",
                        .state = to_string(JobState::preflight),
                        .text = "the clock is right, as was acknowledged: the record of " +
                                wrong_record + " before this one was written by a wrong one",
                        .at = utc_text(clock)});
}

}  // namespace

void check_stage(const JobSettings& settings, const bridge::StageIdentity& stage) {
  refuse(stage_complaints(settings, stage));
}

PreflightFindings inspect(const JobSettings& settings, bridge::Camera& camera,
                          const Surroundings& surroundings, const std::string& wrong_record) {
  PreflightFindings findings;
  camera.apply(settings.camera.settings);
  findings.camera = camera.describe();
  refuse(camera_complaints(settings, findings.camera));
  findings.records =
      std::make_shared<SampleRecords>(settings.plan, settings.store, findings.camera, surroundings);
  findings.journal = findings.records->summary();
  findings.disk_left_layers = findings.records->disk_left_layers();

  check_clock(*findings.records, findings.journal.last_event_at, surroundings.wall_clock(),
              wrong_record);
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
