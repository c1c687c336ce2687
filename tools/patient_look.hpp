#pragma once

#include <chrono>
#include <optional>

#include <nlohmann/json.hpp>

#include "tools/daemon_connection.hpp"

namespace biotomy::tools {

/// Looks at a daemon's status through the night. A daemon that has answered once may be away for a
/// while, as when it is started anew, or have no time: stderr is told once, and it is asked again.
class PatientLook {
 public:
  struct Patience {
    std::chrono::milliseconds most{120'000};  ///< for a daemon that is away
    std::chrono::milliseconds pause{1000};    ///< before it is asked again
  };
  PatientLook(DaemonConnection& daemon, const Patience& patience);

  /// Throws what DaemonConnection::status throws; DaemonAway of a daemon that never answered, or
  /// was away for longer than the patience lasts.
  nlohmann::json status();

 private:
  using TimePoint = std::chrono::steady_clock::time_point;
  bool bears(const DaemonAway& away);

  DaemonConnection& daemon_;
  Patience patience_;
  bool has_answered_ = false;
  std::optional<TimePoint> away_since_;
};

}  // namespace biotomy::tools
