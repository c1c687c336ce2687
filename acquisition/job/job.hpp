#pragma once

#include <cstdint>
#include <future>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "acquisition/calibration/calibration_run.hpp"
#include "acquisition/calibration/frame_calibration.hpp"
#include "acquisition/job/clock_wait.hpp"
#include "acquisition/job/earlier_run.hpp"
#include "acquisition/job/early_notes.hpp"
#include "acquisition/job/hold.hpp"
#include "acquisition/job/job_states.hpp"
#include "acquisition/job/job_status.hpp"
#include "acquisition/job/layer_cycle.hpp"
#include "acquisition/job/operator_desk.hpp"
#include "acquisition/job/preflight.hpp"
#include "acquisition/job/recovery.hpp"
#include "acquisition/job/time_left.hpp"
#include "acquisition/job/unattended_restart.hpp"
#include "acquisition/records/event_writer.hpp"
#include "acquisition/records/record_keeper.hpp"
#include "acquisition/records/surroundings.hpp"
#include "acquisition/rig/channel_comparison.hpp"
#include "acquisition/rig/conditioning.hpp"
#include "acquisition/rig/fault_stop.hpp"
#include "acquisition/rig/homing_step.hpp"
#include "acquisition/rig/parking.hpp"
#include "acquisition/rig/stage_commands.hpp"
#include "acquisition/rig/supervision.hpp"
#include "acquisition/rig/watched_camera.hpp"
#include "acquisition/settings/job_settings.hpp"
#include "acquisition/worker.hpp"

namespace biotomy::acquisition {

/// What a job works with. All outlive it. The camera belongs to the worker's thread, stage and
/// lines to the thread that calls `tick`.
struct JobParts {
  bridge::Stage& stage;
  bridge::Lines& lines;
  bridge::Camera& camera;
  Worker& worker;         ///< for camera and disk
  Worker& volume_worker;  ///< for the volume, which is never in the rig's way
  Worker& event_worker;   ///< for the journal's events, which wait for neither
  OperatorDesk& desk;
  StatusBoard& board;
  /// The camera without any correction of its frames, for calibrations; null: `camera` itself.
  bridge::Camera* plain_camera = nullptr;
  /// What both of them ask, for the journal; null: their troubles are only logged.
  WatchedCamera* watched_camera = nullptr;
};

/// A job from its start to its end, moved on by `tick`: exchange the heartbeat, read the inputs,
/// supervise, answer the operator, move the step at hand on. Nothing in a tick blocks for longer
/// than the devices' response time-outs.
///
/// It begins faulted, as a latch does. An operator opens the latch by `acknowledge`; when it is
/// closed for no other reason than that the daemon has just started, `start` does both. A job that
/// was running when the daemon before this one ended goes on by itself, if the plan says so and the
/// rig is as that daemon's end must have left it.
class Job {
 public:
  Job(const JobSettings& settings, const JobParts& parts, Surroundings surroundings,
      const EarlierRun& earlier);

  void tick(TimePoint now);

  /// The last word before the program ends: stops a rig that could not be brought to rest.
  void halt(TimePoint now);

  JobState state() const { return state_; }

  /// True when nothing moves or is about to, also not the parking after an alarm.
  bool at_rest() const;

 private:
  bool is_watched() const;
  void look_at_lines(TimePoint now);
  void exchange(TimePoint now);
  void supervise(TimePoint now);
  void compare_channels(TimePoint now);
  void hear_camera();
  void hear_operator(TimePoint now);
  void hear(OperatorDesk::Request& request, TimePoint now);
  void answer_operator();
  OperatorReply obey(OperatorCommand command, TimePoint now);
  /// Why the command is refused now; nothing when it is obeyed.
  std::optional<std::string> why_not(OperatorCommand command) const;
  std::optional<std::string> why_not_begin(JobEvent event) const;
  std::optional<std::string> why_not_acknowledge() const;
  std::optional<std::string> turning_wheel() const;
  std::vector<OperatorCommand> accepted_commands() const;
  OperatorReply begin(JobEvent event, TimePoint now);
  OperatorReply acknowledge(TimePoint now);
  OperatorReply do_not_start();
  OperatorReply calibrate(CalibrationKind kind, TimePoint now);
  OperatorReply calibrate_focus(TimePoint now);
  std::optional<std::string> why_no_calibration() const;
  std::optional<std::string> why_no_field() const;
  OperatorReply calibration_begun(const char* kind);
  void poll_calibration(TimePoint now);
  void give_up_calibration(const std::string& why, TimePoint now);
  void confirm_calibration_stopped(TimePoint now);
  void end_calibration(CalibrationStatus::Progress progress, const std::string& sentence);
  void go_on_by_itself(TimePoint now);
  void advance(TimePoint now);
  void count_committed(TimePoint now);
  void publish();

  std::optional<JobEvent> poll_step(TimePoint now);
  std::optional<JobEvent> poll_preflight(TimePoint now);
  std::optional<JobEvent> poll_recovering();
  std::optional<JobEvent> poll_conditioning(TimePoint now);
  std::optional<JobEvent> poll_finishing(TimePoint now);
  std::optional<JobEvent> poll_resetting(TimePoint now);
  void begin_preflight(TimePoint now);
  void begin_inspection(TimePoint now);
  void begin_resetting(TimePoint now);

  /// Takes the transition, which the table must allow, and begins the step it leads to.
  void go(JobEvent event, TimePoint now);
  void enter(JobState state, TimePoint now);
  void fault(const StopCause& why, TimePoint now);
  void begin_rest(TimePoint now);

  /// Temperature or disk are not as they should be, and the configuration lets the job wait.
  void hold(Hold::For what, const std::string& cause, TimePoint now);

  void break_off_parking(const std::string& cause, TimePoint now);
  void add_to_alarm(const std::string& cause);
  void lamp_and_tower(bool tower);
  void note(const char* kind, const std::string& text);
  void note(const char* kind, const std::string& text, std::chrono::system_clock::time_point at);
  void write_early_notes();
  std::optional<std::string> unwritten_record() const;
  std::string waiting_for() const;

  JobSettings settings_;
  JobParts parts_;
  Surroundings surroundings_;
  StageCommands commands_;
  Supervision supervision_;
  ChannelComparison channels_;
  HomingStep homing_;
  Parking parking_;
  FaultStop fault_stop_;
  UnattendedRestart unattended_restart_;

  JobState state_ = JobState::faulted;
  std::optional<Alarm> alarm_;
  bool start_up_latch_ = true;      ///< faulted only because the daemon has just started
  bool temperature_alarm_ = false;  ///< of the alarm's cause
  bool went_on_by_itself_ = false;
  std::string pause_cause_;  ///< as in JobStatus
  struct Answer {
    std::promise<OperatorReply> promise;
    OperatorReply reply;
  };
  std::vector<OperatorDesk::Request> waiting_;  ///< until the controller is seen again
  std::vector<Answer> answers_;  ///< given at the tick's end, when the board shows what they tell
  std::optional<std::promise<OperatorReply>> reset_answer_;  ///< given when the latch has opened
  bool start_after_reset_ = false;
  bool pause_requested_ = false;
  bool shutting_down_ = false;
  bool job_begun_ = false;  ///< and neither done nor aborted

  std::uint16_t heartbeat_ = 0;
  std::optional<bridge::StageStatus> fresh_;  ///< of this tick; nothing when the exchange failed
  std::optional<bridge::StageStatus> last_status_;
  bool silence_logged_ = false;
  bridge::SafetyInputs inputs_;

  TimePoint step_begin_{};
  bool step_command_begun_ = false;

  std::future<PreflightFindings> inspection_;
  std::optional<bridge::StageIdentity> identity_;  ///< once the preflight has asked
  PreflightFindings findings_;
  ClockWait clock_wait_;
  Conditioning conditioning_;
  Hold hold_;
  std::optional<RecordKeeper> keeper_;
  std::optional<EventWriter> events_;
  EarlyNotes early_notes_;
  std::optional<VolumeFeed> feed_;
  std::optional<Continuation> continuation_;
  std::unique_ptr<LayerCycle> cycle_;
  std::unique_ptr<CalibrationRun> calibration_;      ///< while one is under way
  std::optional<std::string> calibration_given_up_;  ///< until its stop is carried out: why
  CalibrationStatus calibration_status_;

  std::int64_t committed_ = 0;
  TimeLeft time_left_;
  std::int64_t volume_seen_ = 0;
  TimePoint volume_moved_{};
};

}  // namespace biotomy::acquisition
