#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <random>
#include <string>

namespace biotomy::tests {

/// What can happen to a message on its way, or to the line under it.
enum class LinkFault {
  delay,      ///< comes late, perhaps after the next one
  drop,       ///< never comes
  duplicate,  ///< comes twice
  truncate,   ///< only its beginning comes
  corrupt,    ///< comes with a bit turned over
  reorder,    ///< comes after the next one of its direction
  cut,        ///< the line is gone, and there again a while later
};
inline constexpr int kLinkFaults = 7;

const char* to_string(LinkFault fault);

struct LinkFaultPlan {
  std::uint64_t seed = 1;
  std::array<double, kLinkFaults> share{};     ///< of the exchanges, for each fault
  std::chrono::milliseconds longest_delay{0};  ///< of a message, and of a line that is gone

  /// Every fault as often as the others.
  static LinkFaultPlan evenly(double share_of_exchanges, std::chrono::milliseconds longest_delay,
                              std::uint64_t seed);
};

struct LinkFaultCounts {
  std::int64_t exchanges = 0;
  std::array<std::int64_t, kLinkFaults> faults{};

  std::int64_t all_faults() const;
  std::string text() const;
};

}  // namespace biotomy::tests
