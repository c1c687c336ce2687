#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>

#include "acquisition/records/journal_rows.hpp"

namespace biotomy::acquisition {

/// The writing side of a sample's journal. What a call has returned from is on disk (WAL,
/// synchronous=FULL). One thread owns it. Every call throws JournalError.
class LayerJournal {
 public:
  /// Opens the journal, makes it if there is none, and brings an older one up to date.
  explicit LayerJournal(const std::filesystem::path& path);
  ~LayerJournal();
  LayerJournal(const LayerJournal&) = delete;
  LayerJournal& operator=(const LayerJournal&) = delete;

  void begin_grind(const GrindRow& grind, const std::string& at);

  /// How the pass ended, and the controller as it was then.
  void end_grind(std::uint32_t sequence, bridge::CommandResult result,
                 const bridge::StageStatus& telemetry, const std::string& at);

  void record_attempt(const AttemptRow& attempt);
  void record_focus(const FocusRow& focus, const std::string& at);
  void record_event(const JobEventRow& event);

  /// In place of those that were recorded before.
  void record_constants(const std::vector<Constant>& constants);

  /// Records the accepted attempt and commits its layer, both or neither.
  void commit_layer(const AttemptRow& attempt, std::uint64_t bytes, const std::string& at);

  JournalSummary summary() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace biotomy::acquisition
