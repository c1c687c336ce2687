#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <variant>

#include "acquisition/records/journal_rows.hpp"
#include "acquisition/settings/job_plan.hpp"
#include "acquisition/settings/safety_limits.hpp"
#include "firmware_bridge/stage/stage.hpp"

namespace biotomy::acquisition {

/// Where the work goes on.
struct Continuation {
  std::int64_t layer = 1;  ///< the first that is not committed; layers + 1 when all are
  bool ground = false;     ///< its face is ground already and waits to be photographed
  std::optional<std::uint32_t> finished_grind;  ///< a pass that ended while nobody wrote it down
};

/// Why it cannot go on, in a sentence that says what disagrees with what.
struct Disagreement {
  std::string sentence;
};

/// Compares what the journal knows with the controller's counters and its absolute position. The
/// controller is idle. Both the counter of grind passes and the deepest ground position must tell
/// the same story: the last pass that was written down before it was issued was finished, or it
/// was not; anything else is a disagreement.
std::variant<Continuation, Disagreement> where_to_go_on(const JobPlan& plan,
                                                        const JournalSummary& journal,
                                                        const bridge::StageStatus& controller,
                                                        const SafetyLimits& limits);

}  // namespace biotomy::acquisition
