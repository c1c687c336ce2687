#pragma once

#include <optional>
#include <set>
#include <string>

#include "acquisition/rig/step_failure.hpp"

namespace biotomy::acquisition {

/// Which of the refused attempts are written down: within a minute one of each kind from each
/// client, ten in all. The others are counted, and the next line says how many there were, so that
/// nobody can fill a disk by guessing tokens. One thread uses it.
class RefusalLog {
 public:
  /// The line to write; nothing when this one is only counted.
  std::optional<std::string> line(const std::string& client, const std::string& what,
                                  TimePoint now);

 private:
  std::optional<TimePoint> minute_;
  std::set<std::string> written_;  ///< in this minute
  long counted_ = 0;               ///< and not told yet
};

}  // namespace biotomy::acquisition
