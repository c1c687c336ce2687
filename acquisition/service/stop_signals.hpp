#pragma once

#include <chrono>
#include <csignal>

namespace biotomy::acquisition {

/// SIGTERM, SIGINT, SIGQUIT and SIGHUP (unless that was ignored already, as nohup does), taken by
/// the main thread alone when it asks; SIGPIPE is ignored. Made before any other thread.
class StopSignals {
 public:
  StopSignals();

  /// True when one came within the time.
  bool wait(std::chrono::milliseconds time) const;

 private:
  sigset_t set_{};
};

}  // namespace biotomy::acquisition
