#include "acquisition/job/job.hpp"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "acquisition/job/step_alarm.hpp"
#include "acquisition/log.hpp"
#include "acquisition/records/utc_time.hpp"
#include "firmware_bridge/device_error.hpp"

namespace biotomy::acquisition {
namespace {

constexpr const char* kComponent = "job";

/// The steps that the layer cycle does.
bool is_layer_step(JobState state) {
  switch (state) {
    case JobState::grinding:
    case JobState::retracting:
    case JobState::clearing:
    case JobState::settling:
    case JobState::lighting:
    case JobState::focusing:
    case JobState::capturing:
    case JobState::assessing:
    case JobState::storing:
      return true;
    default:
      return false;
  }
}

/// Whether the cause for which the job stopped by itself is still the reason to stand still.
bool keeps_pause_cause(JobState from, JobState to) {
  return to == JobState::pausing || to == JobState::withdrawing || to == JobState::held ||
         (to == JobState::paused && from == JobState::pausing);
}

std::string after_colon(const std::string& why) {
  return why.empty() ? "" : ": " + why;
}

std::chrono::milliseconds limit_of(JobState state, const JobSettings& settings) {
  const SafetyLimits& limits = settings.limits;
  switch (state) {
    case JobState::preflight:
      return limits.preflight_limit;
    case JobState::recovering:
      return limits.recovery_limit;
    case JobState::homing:
      return limits.home_limit;
    case JobState::conditioning:
      return limits.conditioning_limit;
    case JobState::held:
      return limits.held_limit;
    case JobState::grinding:
      return limits.grind_limit;
    case JobState::retracting:
      return limits.retract_limit;
    case JobState::clearing:
      return settings.plan.clear_duration + limits.clear_limit;
    case JobState::focusing:
      return limits.focus_limit;
    case JobState::capturing:
      return 2 * settings.camera.capture_time_out + limits.capture_limit;
    case JobState::assessing:
      return limits.assess_limit;
    case JobState::storing:
      return limits.store_limit;
    case JobState::resetting:
      return limits.reset_limit;
    default:
      return std::chrono::milliseconds::max();  // ends by itself, or watches its own limit
  }
}

}  // namespace

Job::Job(const JobSettings& settings, const JobParts& parts, Surroundings surroundings,
         const EarlierRun& earlier)
    : settings_(settings),
      parts_(parts),
      surroundings_(std::move(surroundings)),
      commands_(parts.stage, settings_.limits),
      supervision_(settings_.limits),
      homing_(commands_),
      parking_(commands_, settings_.limits),
      fault_stop_(commands_, settings_.limits),
      unattended_restart_(
          earlier.was_running && settings.plan.after_restart == JobPlan::AfterRestart::go_on,
          settings_.limits),
      clock_wait_(settings_.limits),
      conditioning_(settings_.limits),
      hold_(settings_.limits) {
  commands_.raise_to(earlier.last_sequence);
  committed_ = earlier.committed;
  start_up_latch_ = earlier.alarm.empty();
  alarm_ = Alarm{start_up_latch_
                     ? "the daemon has just started: look at the rig, then acknowledge"
                     : "the daemon was started again after an alarm that nobody acknowledged (" +
                           earlier.alarm + "): look at the rig, then acknowledge",
                 utc_text(surroundings_.wall_clock()), state_, AlarmKind::start_latch};
  publish();
}

bool Job::at_rest() const {
  return is_at_rest(state_) && !calibration_ && fault_stop_.is_over();
}

void Job::tick(TimePoint now) {
  look_at_lines(now);
  exchange(now);
  supervise(now);
  compare_channels(now);
  hear_camera();
  hear_operator(now);
  go_on_by_itself(now);
  advance(now);
  publish();
  answer_operator();
}

/// A rig at rest has nothing to stop; while the latch is being reset, `poll_resetting` looks.
bool Job::is_watched() const {
  if (calibration_ && calibration_->moves_axes()) return true;
  return !is_at_rest(state_) && state_ != JobState::resetting;
}

/// Before the controller is asked: it may take its time-outs to answer, and an e-stop never waits.
void Job::look_at_lines(TimePoint now) {
  inputs_ = parts_.lines.read_inputs();
  const auto cause = Supervision::line_cause(inputs_);
  if (!cause) return;
  if (is_watched()) {
    fault(*cause, now);
  } else if (state_ == JobState::faulted && !at_rest()) {
    break_off_parking(cause->sentence, now);
  }
}

void Job::exchange(TimePoint now) {
  fresh_.reset();
  try {
    fresh_ =
        fault_stop_.gives_heartbeat() ? parts_.stage.exchange(++heartbeat_) : parts_.stage.look();
    if (!last_status_) {
      commands_.raise_to(std::max(fresh_->sequence_started, fresh_->sequence_finished));
    }
    fault_stop_.observe(*fresh_);
    last_status_ = fresh_;
    silence_logged_ = false;
  } catch (const bridge::DeviceError& error) {
    if (!std::exchange(silence_logged_, true)) log_warning("stage", error.what());
  }
  supervision_.observe(fresh_, inputs_, now);
}

void Job::supervise(TimePoint now) {
  if (!is_watched()) return;
  if (const auto cause = supervision_.cause()) {
    fault(*cause, now);
    return;
  }
  if (wheel_must_stand(state_)) {
    if (const auto cause = supervision_.wheel_cause()) {
      fault(*cause, now);
      return;
    }
  }
  if (is_layer_step(state_)) {
    if (const auto cause = supervision_.temperature_cause()) {
      if (settings_.limits.temperature_resumes) {
        hold(Hold::For::temperature, cause->sentence, now);
      } else {
        fault(*cause, now);
        temperature_alarm_ = true;
      }
      return;
    }
  }
  const bool past_homing = is_layer_step(state_) && state_ != JobState::storing;
  if (past_homing && fresh_ && !fresh_->interlocks.homed) {
    fault({AlarmKind::motion, "the controller lost its reference: its axes are not homed any more"},
          now);
    return;
  }
  if (const auto failure = unwritten_record()) {
    fault({AlarmKind::storage, "a record was not written: " + *failure}, now);
  }
}

/// Also at rest: a door is opened there too.
void Job::compare_channels(TimePoint now) {
  if (!fresh_) return;
  channels_.observe(fresh_->interlocks, inputs_, now);
  const auto disagreement = channels_.take_disagreement();
  if (!disagreement) return;
  if (state_ == JobState::faulted) {
    add_to_alarm(*disagreement);
  } else {
    log_warning(kComponent, *disagreement);
    note("recovery", *disagreement);
  }
}

std::optional<std::string> Job::unwritten_record() const {
  std::optional<std::string> failure = keeper_ ? keeper_->failure() : std::nullopt;
  return !failure && events_ ? events_->failure() : failure;
}

void Job::advance(TimePoint now) {
  if (calibration_) poll_calibration(now);
  if (state_ == JobState::faulted) {
    for (const std::string& remark : fault_stop_.poll(fresh_, now)) add_to_alarm(remark);
    return;
  }
  if (is_at_rest(state_)) return;
  try {
    const auto limit = limit_of(state_, settings_);
    if (limit != std::chrono::milliseconds::max() && now - step_begin_ > limit) {
      throw StepFailure(std::string(to_string(state_)) + " took longer than " +
                            std::to_string(limit.count()) + " ms: it " + waiting_for(),
                        AlarmKind::time_limit);
    }
    if (!fresh_) return;  // without a view of the rig nothing moves on
    std::optional<JobEvent> event = poll_step(now);
    count_committed(now);
    const bool only_waits = state_ == JobState::conditioning || state_ == JobState::held;
    if (!event && only_waits && pause_requested_) event = JobEvent::pause;
    if (event) go(*event, now);
  } catch (const DiskFull& error) {
    count_committed(now);
    if (settings_.limits.disk_resumes && next_state(state_, JobEvent::hold)) {
      hold(Hold::For::disk, error.what(), now);
    } else {
      fault({alarm_kind_of(error, state_), error.what()}, now);
    }
  } catch (const std::exception& error) {
    count_committed(now);
    fault({alarm_kind_of(error, state_), error.what()}, now);
  }
}

void Job::count_committed(TimePoint now) {
  if (!cycle_ || !cycle_->last_committed()) return;
  if (cycle_->last_committed()->layer <= committed_) return;
  committed_ = cycle_->last_committed()->layer;
  time_left_.layer_done(now);
}

std::optional<JobEvent> Job::poll_step(TimePoint now) {
  if (is_layer_step(state_)) return cycle_->poll(state_, *fresh_, now);
  switch (state_) {
    case JobState::preflight:
      return poll_preflight(now);
    case JobState::recovering:
      return poll_recovering();
    case JobState::homing:
      return homing_.poll(*fresh_, now) ? std::optional(JobEvent::step_done) : std::nullopt;
    case JobState::conditioning:
      return poll_conditioning(now);
    case JobState::held:
      return hold_.poll(*fresh_, *keeper_, now) ? std::optional(JobEvent::fit_again) : std::nullopt;
    case JobState::pausing:
    case JobState::withdrawing:
    case JobState::aborting:
      return parking_.poll(*fresh_, now) ? std::optional(JobEvent::step_done) : std::nullopt;
    case JobState::finishing:
      return poll_finishing(now);
    case JobState::resetting:
      return poll_resetting(now);
    default:
      return std::nullopt;
  }
}

void Job::go(JobEvent event, TimePoint now) {
  std::optional<JobState> next = next_state(state_, event);
  if (!next) {
    throw std::logic_error(std::string(to_string(event)) + " is forbidden in the state " +
                           to_string(state_));
  }
  if (event == JobEvent::attempts_exhausted) {
    pause_cause_ = cycle_->why_exhausted();
    note("alarm", pause_cause_);
  }
  // A pause that was asked for is taken as soon as the table allows it.
  if (pause_requested_) next = next_state(*next, JobEvent::pause).value_or(*next);
  enter(*next, now);
}

void Job::enter(JobState state, TimePoint now) {
  const JobState from = std::exchange(state_, state);
  if (!keeps_pause_cause(from, state)) pause_cause_.clear();
  step_begin_ = now;
  step_command_begun_ = false;
  // How long a layer takes says nothing when somebody let it wait.
  if (is_at_rest(state) || state == JobState::held) time_left_.interrupted();
  if (is_layer_step(state)) {
    time_left_.begin(now);
    cycle_->begin(state, *fresh_, now);
    return;
  }
  log_info(kComponent, std::string(to_string(from)) + " → " + to_string(state));
  note("state", std::string("from ") + to_string(from));
  switch (state) {
    case JobState::preflight:
      begin_preflight(now);
      break;
    case JobState::homing:
      homing_.begin();
      break;
    case JobState::conditioning:
      conditioning_.begin(now);
      break;
    case JobState::pausing:
    case JobState::withdrawing:
    case JobState::finishing:
    case JobState::aborting:
      if (cycle_) cycle_->abandon(to_string(state));
      lamp_and_tower(state == JobState::withdrawing);
      parking_.begin(state == JobState::aborting || state == JobState::withdrawing
                         ? Parking::From::motion
                         : Parking::From::rest,
                     now);
      volume_moved_ = now;
      if (state == JobState::finishing) feed_->finish(committed_);
      break;
    case JobState::resetting:
      begin_resetting(now);
      break;
    case JobState::idle:
    case JobState::paused:
      pause_requested_ = false;
      begin_rest(now);
      break;
    case JobState::done:
    case JobState::aborted:
      pause_requested_ = false;
      job_begun_ = false;
      break;
    default:
      break;
  }
}

/// The latch may have been reset for a job that is to start; but not in a daemon that ends.
void Job::begin_rest(TimePoint now) {
  const bool starts = std::exchange(start_after_reset_, false) && !shutting_down_;
  if (reset_answer_) {
    answers_.push_back({std::move(*reset_answer_),
                        {true, starts ? "the checks have begun" : "the alarm is acknowledged"}});
  }
  reset_answer_.reset();
  if (starts) go(JobEvent::start, now);
}

void Job::note(const char* kind, const std::string& text) {
  note(kind, text, surroundings_.wall_clock());
}

void Job::note(const char* kind, const std::string& text,
               std::chrono::system_clock::time_point at) {
  JobEventRow row{kind, to_string(state_), cycle_ ? cycle_->layer() : 0, text, utc_text(at)};
  if (events_) {
    events_->post(std::move(row));
  } else {
    early_notes_.add(std::move(row));
  }
}

void Job::write_early_notes() {
  for (JobEventRow& row : early_notes_.take()) events_->post(std::move(row));
}

void Job::hear_camera() {
  if (parts_.watched_camera == nullptr) return;
  for (const WatchedCamera::Trouble& trouble : parts_.watched_camera->take_troubles()) {
    note("recovery", trouble.sentence, trouble.at);
  }
}

std::string Job::waiting_for() const {
  if (!fresh_ && !is_at_rest(state_)) return "waits for the controller to answer";
  if (is_layer_step(state_)) return cycle_->waiting_for(state_);
  switch (state_) {
    case JobState::preflight:
      if (!identity_) return "waits for the controller to say what it is";
      return clock_wait_.waiting_for().empty() ? "waits for the camera, the sample and the disk"
                                               : clock_wait_.waiting_for();
    case JobState::recovering:
      return "waits for the controller to be idle and the wheel to stand";
    case JobState::homing:
      return "waits for the axes to find their reference";
    case JobState::conditioning:
      return conditioning_.waiting_for();
    case JobState::held:
      return hold_.waiting_for();
    case JobState::pausing:
    case JobState::withdrawing:
    case JobState::aborting:
      return parking_.waiting_for();
    case JobState::finishing: {
      const std::string parking = parking_.waiting_for();
      return parking.empty() ? "waits for the volume to be complete" : parking;
    }
    case JobState::resetting:
      return "waits for the controller to leave its fault";
    case JobState::faulted:
      if (!fault_stop_.is_over()) return "waits for the rig to be parked";
      // Before the first look at the controller there is nothing to say of it.
      return "waits for an operator to acknowledge" +
             (last_status_ ? after_colon(why_not_acknowledge().value_or("")) : "");
    case JobState::paused:
      return "waits for an operator to resume" + after_colon(pause_cause_);
    default:
      return "";
  }
}

void Job::publish() {
  JobStatus status;
  status.state = state_;
  status.waiting_for = waiting_for();
  status.pause_requested = pause_requested_;
  status.pause_cause = pause_cause_;
  status.job = settings_.plan.name;
  status.sample = settings_.plan.sample.string();
  status.layers = settings_.plan.layers;
  status.committed = committed_;
  if (!is_at_rest(state_)) {
    const std::int64_t layers_left = settings_.plan.layers - committed_;
    status.seconds_left = time_left_.estimate(layers_left);
    status.seconds_left_range = time_left_.range(layers_left);
  }
  status.commands = accepted_commands();
  status.controller_answers = fresh_.has_value();
  status.stage = last_status_;
  status.lines = inputs_;
  status.alarm = alarm_;
  status.calibration = calibration_status_;
  if (cycle_) {
    status.layer = cycle_->layer();
    status.attempt = cycle_->attempt();
    status.last_attempt = cycle_->last_judged();
    status.last_layer = cycle_->last_committed();
    status.focus = cycle_->last_focus();
    status.disk_left_layers = cycle_->disk_left_layers();
  }
  if (feed_) status.volume = feed_->progress();
  parts_.board.publish(std::move(status));
}

}  // namespace biotomy::acquisition
