#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "acquisition/service/notifications/notifier.hpp"
#include "acquisition/service/notifications/run_watch.hpp"
#include "firmware_bridge/wire/checked_table.hpp"

namespace biotomy::acquisition {

struct NotifyConfiguration {
  std::vector<std::string> command;  ///< program and arguments; none: no command
  std::string webhook;               ///< URL; empty: no webhook
  std::filesystem::path webhook_token_file;
  NotifierSettings notifier;
  WatchLimits watch;

  /// Whether anybody is told at all.
  bool is_on() const { return !command.empty() || !webhook.empty(); }
};

/// [notify] of rig.toml.
NotifyConfiguration read_notify(const bridge::CheckedTable& table);

}  // namespace biotomy::acquisition
