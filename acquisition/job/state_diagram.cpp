#include "acquisition/job/state_diagram.hpp"

#include <array>

#include "acquisition/job/job_states.hpp"

namespace biotomy::acquisition {
namespace {

/// Events that nearly every state knows: drawn once, in words, so that the drawing can be read.
constexpr std::array kFromManyStates = {JobEvent::alarm, JobEvent::abort, JobEvent::pause,
                                        JobEvent::hold};

bool is_drawn(JobEvent event) {
  for (const JobEvent one : kFromManyStates) {
    if (event == one) return false;
  }
  return true;
}

std::string name(auto value) {
  return "`" + std::string(to_string(value)) + "`";
}

/// "`pause` leads to `pausing` from `recovering`, …", a line for each state that the event leads
/// to.
std::string in_words(JobEvent event) {
  std::string text;
  for (const JobState to : all_job_states()) {
    std::string from;
    for (const Transition& transition : transitions()) {
      if (transition.event != event || transition.to != to) continue;
      from += (from.empty() ? "" : ", ") + name(transition.from);
    }
    if (!from.empty()) {
      text += "- " + name(event) + " leads to " + name(to) + " from " + from + ".\n";
    }
  }
  return text;
}

}  // namespace

std::string state_diagram() {
  std::string text =
      "# The states of a job\n\n"
      "Made from the table in `acquisition/job/job_states.cpp` by `biotomyd --state-diagram`. What "
      "is neither in the drawing nor in the list is forbidden. The daemon starts in `faulted`, as "
      "a latch does. A pause that was asked for is taken where a step ends, with the next step "
      "passed over: log and journal may tell of `preflight` and then of `pausing`.\n\n"
      "```mermaid\nstateDiagram-v2\n  [*] --> faulted\n";
  for (const Transition& transition : transitions()) {
    if (!is_drawn(transition.event)) continue;
    text += std::string("  ") + to_string(transition.from) + " --> " + to_string(transition.to) +
            ": " + to_string(transition.event) + "\n";
  }
  text += "```\n\n";
  for (const JobEvent event : kFromManyStates) text += in_words(event);
  return text;
}

}  // namespace biotomy::acquisition
