#pragma once

#include <exception>

#include "acquisition/job/job_states.hpp"
#include "acquisition/rig/alarm_kind.hpp"

namespace biotomy::acquisition {

/// What an error that ended a step is about: by itself where it says so, else by the step.
AlarmKind alarm_kind_of(const std::exception& error, JobState state);

}  // namespace biotomy::acquisition
