#include "tests/faults/link_faults.hpp"

#include <numeric>

namespace biotomy::tests {

const char* to_string(LinkFault fault) {
  switch (fault) {
    case LinkFault::delay:
      return "delayed";
    case LinkFault::drop:
      return "dropped";
    case LinkFault::duplicate:
      return "duplicated";
    case LinkFault::truncate:
      return "truncated";
    case LinkFault::corrupt:
      return "corrupted";
    case LinkFault::reorder:
      return "reordered";
    case LinkFault::cut:
      return "cut";
  }
  return "unknown";
}

LinkFaultPlan LinkFaultPlan::evenly(double share_of_exchanges,
                                    std::chrono::milliseconds longest_delay, std::uint64_t seed) {
  LinkFaultPlan plan{.seed = seed, .share = {}, .longest_delay = longest_delay};
  plan.share.fill(share_of_exchanges / kLinkFaults);
  return plan;
}

std::int64_t LinkFaultCounts::all_faults() const {
  return std::accumulate(faults.begin(), faults.end(), std::int64_t{0});
}

std::string LinkFaultCounts::text() const {
  std::string text = std::to_string(exchanges) + " exchanges";
  for (int fault = 0; fault < kLinkFaults; ++fault) {
    text += ", " + std::to_string(faults[static_cast<std::size_t>(fault)]) + " " +
            to_string(static_cast<LinkFault>(fault));
  }
  return text;
}

}  // namespace biotomy::tests
