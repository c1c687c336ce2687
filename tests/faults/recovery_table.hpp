#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <vector>

namespace biotomy::tests {

/// What was measured of a fault, for docs/operation.md.
struct Recovery {
  std::string fault;
  std::string told;                                  ///< to the operator
  std::optional<std::chrono::milliseconds> to_stop;  ///< of the wheel; nothing: it stood
  std::chrono::milliseconds to_layer{0};             ///< from mending to the next committed layer
};

/// Collects what the tests of this program measured; printed as a table when they are over.
void note_recovery(Recovery recovery);

}  // namespace biotomy::tests
