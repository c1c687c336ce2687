#include "acquisition/service/attempt_watch.hpp"

#include <cstdint>
#include <utility>

#include "acquisition/log.hpp"
#include "acquisition/records/journal_error.hpp"
#include "acquisition/records/journal_reader.hpp"

namespace biotomy::acquisition {
namespace {

constexpr std::int64_t kMostAtOnce = 1000;

}  // namespace

AttemptWatch::AttemptWatch(std::filesystem::path journal)
    : journal_(std::move(journal)), log_(journal_.string() + "-wal") {
  try {
    if (!std::filesystem::exists(journal_)) return;
    const JournalReader reader(journal_);
    const auto newest = reader.attempts_after(reader.last_attempt_id() - 1, 1);
    if (!newest.empty()) last_ = newest.back();
  } catch (const JournalError& error) {
    // One of an older daemon, which this one will bring up to date.
    log_warning("events", error.what());
  }
}

std::string AttemptWatch::files_state() const {
  std::string state;
  for (const std::filesystem::path& file : {journal_, log_}) {
    std::error_code none;
    state += std::to_string(std::filesystem::file_size(file, none)) + " ";
    const auto written = std::filesystem::last_write_time(file, none);
    state += std::to_string(written.time_since_epoch().count()) + " ";
  }
  return state;
}

bool AttemptWatch::is_at_rest() const {
  std::error_code none;
  const std::uintmax_t bytes = std::filesystem::file_size(log_, none);
  return none || bytes == 0;
}

std::vector<AttemptNote> AttemptWatch::look() {
  if (!std::filesystem::exists(journal_)) return {};
  std::string state = files_state();
  if (state == seen_ && is_at_rest()) return {};
  const auto known = last();
  std::vector<AttemptNote> found =
      JournalReader(journal_).attempts_after(known ? known->id : 0, kMostAtOnce);
  if (!found.empty()) {
    const std::scoped_lock lock(mutex_);
    last_ = found.back();
  }
  // Of more than that there may be a rest, to be read at the next look.
  if (static_cast<std::int64_t>(found.size()) < kMostAtOnce) seen_ = std::move(state);
  return found;
}

std::optional<AttemptNote> AttemptWatch::last() const {
  const std::scoped_lock lock(mutex_);
  return last_;
}

std::optional<std::vector<AttemptNote>> missed_attempts(const std::filesystem::path& journal,
                                                        std::int64_t id, std::int64_t until) {
  if (id > until) return std::nullopt;
  if (id == until || !std::filesystem::exists(journal)) return std::vector<AttemptNote>{};
  std::vector<AttemptNote> found = JournalReader(journal).attempts_after(id, kMostAtOnce + 1);
  std::erase_if(found, [until](const AttemptNote& note) { return note.id > until; });
  if (static_cast<std::int64_t>(found.size()) > kMostAtOnce) return std::nullopt;
  return found;
}

}  // namespace biotomy::acquisition
