#include "acquisition/job/job_states.hpp"

#include <array>

namespace biotomy::acquisition {
namespace {

using enum JobState;
using Event = JobEvent;

constexpr std::array kStates = {
    idle,      preflight, recovering, homing,    conditioning, grinding, retracting, clearing,
    settling,  lighting,  focusing,   capturing, assessing,    storing,  pausing,    withdrawing,
    finishing, aborting,  held,       paused,    done,         aborted,  faulted,    resetting};

constexpr std::array kEvents = {Event::start,
                                Event::step_done,
                                Event::agreed,
                                Event::grind_next,
                                Event::photograph_next,
                                Event::nothing_left,
                                Event::frame_accepted,
                                Event::take_again,
                                Event::focus_again,
                                Event::clear_again,
                                Event::attempts_exhausted,
                                Event::layer_committed,
                                Event::hold,
                                Event::fit_again,
                                Event::pause,
                                Event::resume,
                                Event::abort,
                                Event::alarm,
                                Event::acknowledge,
                                Event::reset_with_job,
                                Event::reset_without_job};

constexpr std::array kTransitions = {
    // Beginning. Resuming takes the same way as starting: what the journal and the controller say
    // decides, never what the daemon remembers.
    Transition{idle, Event::start, preflight},
    Transition{done, Event::start, preflight},
    Transition{aborted, Event::start, preflight},
    Transition{paused, Event::resume, preflight},
    Transition{preflight, Event::step_done, recovering},
    Transition{recovering, Event::agreed, homing},
    Transition{recovering, Event::nothing_left, finishing},
    Transition{homing, Event::step_done, conditioning},
    Transition{conditioning, Event::grind_next, grinding},
    Transition{conditioning, Event::photograph_next, retracting},

    // A layer.
    Transition{grinding, Event::step_done, retracting},
    Transition{retracting, Event::step_done, clearing},
    Transition{clearing, Event::step_done, settling},
    Transition{settling, Event::step_done, lighting},
    Transition{lighting, Event::step_done, focusing},
    Transition{focusing, Event::step_done, capturing},
    Transition{capturing, Event::step_done, assessing},
    Transition{assessing, Event::frame_accepted, storing},
    Transition{assessing, Event::take_again, capturing},
    Transition{assessing, Event::focus_again, focusing},
    Transition{assessing, Event::clear_again, clearing},
    Transition{assessing, Event::attempts_exhausted, pausing},
    Transition{storing, Event::layer_committed, grinding},
    Transition{storing, Event::nothing_left, finishing},

    // Holding: temperature or disk are not as they should be, and the configuration lets the job go
    // on by itself when they are again. It then begins as a resumed one does.
    Transition{grinding, Event::hold, withdrawing},
    Transition{retracting, Event::hold, withdrawing},
    Transition{clearing, Event::hold, withdrawing},
    Transition{settling, Event::hold, withdrawing},
    Transition{lighting, Event::hold, withdrawing},
    Transition{focusing, Event::hold, withdrawing},
    Transition{capturing, Event::hold, withdrawing},
    Transition{assessing, Event::hold, withdrawing},
    Transition{storing, Event::hold, withdrawing},
    Transition{withdrawing, Event::step_done, held},
    Transition{held, Event::fit_again, preflight},
    Transition{held, Event::pause, paused},

    // Pausing, between two steps. A frame in hand is judged and stored first: `assessing` and
    // `storing` do not pause.
    Transition{recovering, Event::pause, pausing},
    Transition{homing, Event::pause, pausing},
    Transition{conditioning, Event::pause, pausing},
    Transition{grinding, Event::pause, pausing},
    Transition{retracting, Event::pause, pausing},
    Transition{clearing, Event::pause, pausing},
    Transition{settling, Event::pause, pausing},
    Transition{lighting, Event::pause, pausing},
    Transition{focusing, Event::pause, pausing},
    Transition{capturing, Event::pause, pausing},
    Transition{pausing, Event::step_done, paused},
    Transition{finishing, Event::step_done, done},

    // Aborting, at any moment.
    Transition{preflight, Event::abort, aborting},
    Transition{recovering, Event::abort, aborting},
    Transition{homing, Event::abort, aborting},
    Transition{conditioning, Event::abort, aborting},
    Transition{grinding, Event::abort, aborting},
    Transition{retracting, Event::abort, aborting},
    Transition{clearing, Event::abort, aborting},
    Transition{settling, Event::abort, aborting},
    Transition{lighting, Event::abort, aborting},
    Transition{focusing, Event::abort, aborting},
    Transition{capturing, Event::abort, aborting},
    Transition{assessing, Event::abort, aborting},
    Transition{storing, Event::abort, aborting},
    Transition{pausing, Event::abort, aborting},
    Transition{withdrawing, Event::abort, aborting},
    Transition{held, Event::abort, aborting},
    Transition{finishing, Event::abort, aborting},
    Transition{paused, Event::abort, aborting},
    Transition{aborting, Event::step_done, aborted},

    // Alarms: from every state in which something moves or is about to.
    Transition{preflight, Event::alarm, faulted},
    Transition{recovering, Event::alarm, faulted},
    Transition{homing, Event::alarm, faulted},
    Transition{conditioning, Event::alarm, faulted},
    Transition{grinding, Event::alarm, faulted},
    Transition{retracting, Event::alarm, faulted},
    Transition{clearing, Event::alarm, faulted},
    Transition{settling, Event::alarm, faulted},
    Transition{lighting, Event::alarm, faulted},
    Transition{focusing, Event::alarm, faulted},
    Transition{capturing, Event::alarm, faulted},
    Transition{assessing, Event::alarm, faulted},
    Transition{storing, Event::alarm, faulted},
    Transition{pausing, Event::alarm, faulted},
    Transition{withdrawing, Event::alarm, faulted},
    Transition{held, Event::alarm, faulted},
    Transition{finishing, Event::alarm, faulted},
    Transition{aborting, Event::alarm, faulted},
    Transition{resetting, Event::alarm, faulted},

    // The latch.
    Transition{faulted, Event::acknowledge, resetting},
    Transition{resetting, Event::reset_with_job, paused},
    Transition{resetting, Event::reset_without_job, idle},
};

constexpr bool no_event_leads_to_two_states() {
  for (std::size_t i = 0; i < kTransitions.size(); ++i) {
    for (std::size_t j = i + 1; j < kTransitions.size(); ++j) {
      if (kTransitions[i].from == kTransitions[j].from &&
          kTransitions[i].event == kTransitions[j].event) {
        return false;
      }
    }
  }
  return true;
}
static_assert(no_event_leads_to_two_states());

}  // namespace

std::span<const Transition> transitions() {
  return kTransitions;
}

std::optional<JobState> next_state(JobState state, JobEvent event) {
  for (const Transition& transition : kTransitions) {
    if (transition.from == state && transition.event == event) return transition.to;
  }
  return std::nullopt;
}

bool is_at_rest(JobState state) {
  return state == idle || state == paused || state == done || state == aborted || state == faulted;
}

bool wheel_must_stand(JobState state) {
  switch (state) {
    case preflight:
    case recovering:
    case homing:
    case conditioning:
    case clearing:
    case settling:
    case lighting:
    case focusing:
    case capturing:
    case assessing:
    case storing:
    case held:
      return true;
    default:
      return false;
  }
}

std::span<const JobState> all_job_states() {
  return kStates;
}

std::span<const JobEvent> all_job_events() {
  return kEvents;
}

const char* to_string(JobState state) {
  switch (state) {
    case idle:
      return "idle";
    case preflight:
      return "preflight";
    case recovering:
      return "recovering";
    case homing:
      return "homing";
    case conditioning:
      return "conditioning";
    case grinding:
      return "grinding";
    case retracting:
      return "retracting";
    case clearing:
      return "clearing";
    case settling:
      return "settling";
    case lighting:
      return "lighting";
    case focusing:
      return "focusing";
    case capturing:
      return "capturing";
    case assessing:
      return "assessing";
    case storing:
      return "storing";
    case pausing:
      return "pausing";
    case withdrawing:
      return "withdrawing";
    case finishing:
      return "finishing";
    case aborting:
      return "aborting";
    case held:
      return "held";
    case paused:
      return "paused";
    case done:
      return "done";
    case aborted:
      return "aborted";
    case faulted:
      return "faulted";
    case resetting:
      return "resetting";
  }
  return "?";
}

const char* to_string(JobEvent event) {
  switch (event) {
    case Event::start:
      return "start";
    case Event::step_done:
      return "step_done";
    case Event::agreed:
      return "agreed";
    case Event::grind_next:
      return "grind_next";
    case Event::photograph_next:
      return "photograph_next";
    case Event::nothing_left:
      return "nothing_left";
    case Event::frame_accepted:
      return "frame_accepted";
    case Event::take_again:
      return "take_again";
    case Event::focus_again:
      return "focus_again";
    case Event::clear_again:
      return "clear_again";
    case Event::attempts_exhausted:
      return "attempts_exhausted";
    case Event::layer_committed:
      return "layer_committed";
    case Event::hold:
      return "hold";
    case Event::fit_again:
      return "fit_again";
    case Event::pause:
      return "pause";
    case Event::resume:
      return "resume";
    case Event::abort:
      return "abort";
    case Event::alarm:
      return "alarm";
    case Event::acknowledge:
      return "acknowledge";
    case Event::reset_with_job:
      return "reset_with_job";
    case Event::reset_without_job:
      return "reset_without_job";
  }
  return "?";
}

}  // namespace biotomy::acquisition
