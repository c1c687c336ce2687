#include "acquisition/job/quality_ladder.hpp"

namespace biotomy::acquisition {

std::optional<JobEvent> after_rejection(int attempts, const LadderSettings& settings) {
  if (attempts >= settings.max_attempts) return std::nullopt;
  if (attempts == 1) return JobEvent::take_again;
  if (attempts == 2) return JobEvent::focus_again;
  return JobEvent::clear_again;
}

}  // namespace biotomy::acquisition
