#pragma once

#include <optional>
#include <span>

namespace biotomy::acquisition {

/// Where a job is. `faulted` is a latch: the daemon starts in it, and it is left only when an
/// operator acknowledges while the cause is gone and the safety inputs are good.
enum class JobState {
  idle,
  preflight,   ///< everything is asked whether it is fit to run
  recovering,  ///< journal and controller are compared: where does the work go on?
  homing,
  conditioning,  ///< the block is not yet, or not any more, as cold as it must be
  grinding,
  retracting,
  clearing,
  settling,
  lighting,
  focusing,
  capturing,
  assessing,
  storing,
  pausing,      ///< the wheel is being parked for a pause
  withdrawing,  ///< the wheel is being stopped and parked until the rig is fit to run again
  finishing,    ///< the wheel is being parked, the volume completed
  aborting,     ///< the wheel is being stopped and parked for good
  held,         ///< parked; goes on by itself once temperature or disk allow it
  paused,
  done,
  aborted,
  faulted,
  resetting,  ///< acknowledged; the controller's own latch is being reset
};

/// What moves a job from state to state.
enum class JobEvent {
  start,
  step_done,
  agreed,           ///< journal and controller agree
  grind_next,       ///< the next layer is still to be ground
  photograph_next,  ///< the next layer's face is already ground
  nothing_left,     ///< every layer is committed
  frame_accepted,
  take_again,
  focus_again,
  clear_again,
  attempts_exhausted,  ///< no frame was good enough, and a person is to decide
  layer_committed,
  hold,       ///< the rig is not fit to run just now, and may go on by itself later
  fit_again,  ///< what it was held for is over
  pause,
  resume,
  abort,
  alarm,
  acknowledge,
  reset_with_job,  ///< the latch is open again, and a job waits to be resumed
  reset_without_job,
};

struct Transition {
  JobState from;
  JobEvent event;
  JobState to;
};

/// The one table of what is allowed. Everything that is not in it is forbidden.
std::span<const Transition> transitions();

/// Where `event` leads from `state`; nothing when it is forbidden there.
std::optional<JobState> next_state(JobState state, JobEvent event);

/// True where nothing of the rig moves or is about to: idle, paused, done, aborted, faulted.
bool is_at_rest(JobState state);

/// True where the wheel was seen to stand and must not turn: from the retract to the next pass.
bool wheel_must_stand(JobState state);

std::span<const JobState> all_job_states();
std::span<const JobEvent> all_job_events();
const char* to_string(JobState state);
const char* to_string(JobEvent event);

}  // namespace biotomy::acquisition
