#pragma once

#include <chrono>
#include <optional>
#include <string>

#include "acquisition/job/job_status.hpp"

namespace biotomy::acquisition {

/// The daemon's word to systemd (sd_notify). Without systemd every call does nothing.
class ServiceManager {
 public:
  ServiceManager();

  void ready();

  /// One line for `systemctl status`; the same line is not sent twice in a row.
  void status(const std::string& text);

  /// The daemon makes progress. Only sent when systemd watches it.
  void alive() const;

  /// Without a sign of life for so long systemd kills the daemon; nothing when it does not watch.
  const std::optional<std::chrono::microseconds>& watchdog_period() const {
    return watchdog_period_;
  }

  void stopping();

  /// The start, or the stop, needs up to `time` from now.
  void extend(std::chrono::milliseconds time) const;

 private:
  std::optional<std::chrono::microseconds> watchdog_period_;
  std::string last_status_;
};

/// What `systemctl status` shows: the state, layer n of N, what is waited for or the alarm.
std::string status_line(const JobStatus& status);

}  // namespace biotomy::acquisition
