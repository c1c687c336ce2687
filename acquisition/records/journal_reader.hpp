#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <vector>

#include "acquisition/records/journal_rows.hpp"

namespace biotomy::acquisition {

/// The reading side of a journal, while it may still be written. One thread owns it. Every call
/// throws JournalError.
class JournalReader {
 public:
  /// Whether somebody may write it meanwhile. Of one at rest nothing is left behind, not even the
  /// files by which readers and the writer agree.
  enum class Journal { in_use, at_rest };
  explicit JournalReader(const std::filesystem::path& path, Journal is = Journal::in_use);
  ~JournalReader();
  JournalReader(const JournalReader&) = delete;
  JournalReader& operator=(const JournalReader&) = delete;

  /// Committed layers in growing order, at most `limit`, the first not before `from`.
  std::vector<LayerRow> committed_layers(std::int64_t from, std::int64_t limit) const;

  /// All attempts at a layer, in their order.
  std::vector<AttemptNote> attempts(std::int64_t layer) const;

  /// Attempts at any layer that were written down after the one with that id, in their order, at
  /// most `limit`.
  std::vector<AttemptNote> attempts_after(std::int64_t id, std::int64_t limit) const;

  /// The id of the attempt that was written down last; 0 if there is none.
  std::int64_t last_attempt_id() const;

  /// The attempts that gave no layer, the newest first, at most `limit`; those before the one with
  /// the id `before`.
  std::vector<AttemptNote> rejected_before(std::int64_t before, std::int64_t limit) const;

  std::int64_t rejected_count() const;

  /// Whether an attempt's picture was kept under this name, relative to the sample folder.
  bool names_file(const std::string& file) const;

  /// All attempts after the one with the id `after`, in the order of their ids, and of each the
  /// metrics of these names alone: 10000 layers take a fraction of a second.
  AttemptHistory history(const std::vector<std::string>& metrics, std::int64_t after) const;

  std::int64_t committed_count() const;

  /// The layers at which a job began or went on, in the order of its starts: what it knew of those
  /// before was what it recalled.
  std::vector<std::int64_t> starts() const;

  JournalSummary summary() const;

  /// The highest number of a command in it; 0 if none.
  std::uint32_t last_sequence() const;

  /// The state that the job entered last, by its name: "faulted" after an alarm, empty if there is
  /// none. The steps of a layer are not written down one by one: in them it is the state before the
  /// first.
  std::string last_state() const;

  /// The alarm that stopped the job, if nobody has acknowledged it; empty if there is none.
  std::string standing_alarm() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace biotomy::acquisition
