#include "acquisition/job/quality_ladder.hpp"

namespace biotomy::acquisition {

std::optional<JobEvent> after_rejection(int attempts, int unchanged,
                                        const LadderSettings& settings) {
  constexpr int kAgreed = 2;
  if (attempts >= settings.max_attempts || unchanged >= kAgreed) return std::nullopt;
  if (attempts == 1) return JobEvent::take_again;
  if (attempts == 2) return JobEvent::focus_again;
  return JobEvent::clear_again;
}

}  // namespace biotomy::acquisition
