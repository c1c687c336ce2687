#include "acquisition/job/early_notes.hpp"

#include <utility>

namespace biotomy::acquisition {
namespace {

constexpr std::size_t kMost = 1000;

}  // namespace

void EarlyNotes::add(JobEventRow row) {
  if (rows_.size() >= kMost) {
    rows_.erase(rows_.begin());
    ++forgotten_;
  }
  rows_.push_back(std::move(row));
}

std::vector<JobEventRow> EarlyNotes::take() {
  std::vector<JobEventRow> rows = std::exchange(rows_, {});
  if (const long forgotten = std::exchange(forgotten_, 0); forgotten > 0) {
    JobEventRow gap = rows.front();
    gap.kind = "operator";
    gap.text = std::to_string(forgotten) +
               " earlier events came before a journal was open: only the log has them";
    rows.insert(rows.begin(), std::move(gap));
  }
  return rows;
}

}  // namespace biotomy::acquisition
