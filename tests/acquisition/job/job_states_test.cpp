#include "acquisition/job/job_states.hpp"

#include <map>
#include <set>
#include <string>

#include <gtest/gtest.h>

namespace biotomy::acquisition {
namespace {

using Allowed = std::map<JobEvent, JobState>;

/// What each state allows, written down a second time and grouped by state, not by purpose.
std::map<JobState, Allowed> expected() {
  using S = JobState;
  using E = JobEvent;
  const Allowed stoppable = {{E::abort, S::aborting}, {E::alarm, S::faulted}};
  const Allowed pausable = {
      {E::pause, S::pausing}, {E::abort, S::aborting}, {E::alarm, S::faulted}};
  Allowed in_a_layer = pausable;
  in_a_layer[E::hold] = S::withdrawing;
  const Allowed with_a_frame = {
      {E::hold, S::withdrawing}, {E::abort, S::aborting}, {E::alarm, S::faulted}};
  const auto with = [](Allowed base, const Allowed& more) {
    base.insert(more.begin(), more.end());
    return base;
  };
  return {
      {S::idle, {{E::start, S::preflight}}},
      {S::done, {{E::start, S::preflight}}},
      {S::aborted, {{E::start, S::preflight}}},
      {S::paused, {{E::resume, S::preflight}, {E::abort, S::aborting}}},
      {S::faulted, {{E::acknowledge, S::resetting}}},
      {S::resetting,
       {{E::reset_with_job, S::paused}, {E::reset_without_job, S::idle}, {E::alarm, S::faulted}}},
      {S::preflight, with(stoppable, {{E::step_done, S::recovering}})},
      {S::recovering, with(pausable, {{E::agreed, S::homing}, {E::nothing_left, S::finishing}})},
      {S::homing, with(pausable, {{E::step_done, S::conditioning}})},
      {S::conditioning,
       with(pausable, {{E::grind_next, S::grinding}, {E::photograph_next, S::retracting}})},
      {S::grinding, with(in_a_layer, {{E::step_done, S::retracting}})},
      {S::retracting, with(in_a_layer, {{E::step_done, S::clearing}})},
      {S::clearing, with(in_a_layer, {{E::step_done, S::settling}})},
      {S::settling, with(in_a_layer, {{E::step_done, S::lighting}})},
      {S::lighting, with(in_a_layer, {{E::step_done, S::focusing}})},
      {S::focusing, with(in_a_layer, {{E::step_done, S::capturing}})},
      {S::capturing, with(in_a_layer, {{E::step_done, S::assessing}})},
      {S::assessing, with(with_a_frame, {{E::frame_accepted, S::storing},
                                         {E::take_again, S::capturing},
                                         {E::focus_again, S::focusing},
                                         {E::clear_again, S::clearing},
                                         {E::attempts_exhausted, S::pausing}})},
      {S::storing,
       with(with_a_frame, {{E::layer_committed, S::grinding}, {E::nothing_left, S::finishing}})},
      {S::pausing, with(stoppable, {{E::step_done, S::paused}})},
      {S::withdrawing, with(stoppable, {{E::step_done, S::held}})},
      {S::held, with(stoppable, {{E::fit_again, S::preflight}, {E::pause, S::paused}})},
      {S::finishing, with(stoppable, {{E::step_done, S::done}})},
      {S::aborting, {{E::step_done, S::aborted}, {E::alarm, S::faulted}}},
  };
}

TEST(JobStates, AllowExactlyTheTransitionsOfTheTableAndForbidAllOthers) {
  const auto allowed = expected();
  ASSERT_EQ(allowed.size(), all_job_states().size());
  std::size_t count = 0;
  for (const JobState state : all_job_states()) {
    const Allowed& here = allowed.at(state);
    for (const JobEvent event : all_job_events()) {
      const auto found = here.find(event);
      const auto next = next_state(state, event);
      if (found == here.end()) {
        EXPECT_EQ(next, std::nullopt) << to_string(event) << " in " << to_string(state);
      } else {
        EXPECT_EQ(next, found->second) << to_string(event) << " in " << to_string(state);
        ++count;
      }
    }
  }
  EXPECT_EQ(count, transitions().size());
}

TEST(JobStates, LetAnAlarmStopEveryStateInWhichSomethingMoves) {
  for (const JobState state : all_job_states()) {
    if (is_at_rest(state)) continue;
    EXPECT_EQ(next_state(state, JobEvent::alarm), JobState::faulted) << to_string(state);
  }
}

TEST(JobStates, LeaveFaultedOnlyByAnAcknowledgement) {
  for (const JobEvent event : all_job_events()) {
    EXPECT_EQ(next_state(JobState::faulted, event).has_value(), event == JobEvent::acknowledge);
  }
}

// From the air blast on, what turns would be a wheel above the open face; and before the first pass
// nothing has told it to turn.
TEST(JobStates, LetTheWheelTurnNeitherOverAFaceThatIsPhotographedNorWhileTheyOnlyWait) {
  const std::set<JobState> standing = {
      JobState::preflight, JobState::recovering, JobState::homing,   JobState::conditioning,
      JobState::clearing,  JobState::settling,   JobState::lighting, JobState::focusing,
      JobState::capturing, JobState::assessing,  JobState::storing,  JobState::held};
  for (const JobState state : all_job_states()) {
    EXPECT_EQ(wheel_must_stand(state), standing.contains(state)) << to_string(state);
  }
}

TEST(JobStates, AndEventsHaveEachANameOfTheirOwn) {
  std::set<std::string> names;
  for (const JobState state : all_job_states()) names.insert(to_string(state));
  EXPECT_EQ(names.size(), all_job_states().size());
  names.clear();
  for (const JobEvent event : all_job_events()) names.insert(to_string(event));
  EXPECT_EQ(names.size(), all_job_events().size());
}

}  // namespace
}  // namespace biotomy::acquisition
