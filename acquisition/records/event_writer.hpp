#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "acquisition/records/journal_rows.hpp"
#include "acquisition/worker.hpp"

namespace biotomy::acquisition {

/// Writes what happens to a job (states, alarms, what operators ask) into its journal, by a
/// connection and a worker of its own. Behind a camera that hangs, or a layer that a slow disk
/// takes, an alarm would wait, and be forgotten if the power went meanwhile; a daemon that was told
/// to go on by itself would then go on.
class EventWriter {
 public:
  /// The journal is there. The worker outlives the writer, and closes the journal after all that
  /// was posted.
  EventWriter(Worker& worker, std::filesystem::path journal);
  ~EventWriter();
  EventWriter(const EventWriter&) = delete;
  EventWriter& operator=(const EventWriter&) = delete;

  /// Writes without anybody waiting. If it fails, `failure` tells so for ever.
  void post(JobEventRow event);

  /// Why an event could not be written; nothing when all were.
  std::optional<std::string> failure() const;

 private:
  struct State;
  Worker& worker_;
  std::shared_ptr<State> state_;
};

}  // namespace biotomy::acquisition
