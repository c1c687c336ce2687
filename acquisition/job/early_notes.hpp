#pragma once

#include <vector>

#include "acquisition/records/journal_rows.hpp"

namespace biotomy::acquisition {

/// What happened while no journal was open, to be written once one is. It keeps the newest
/// thousand; a row in front of them tells how many older ones there were.
class EarlyNotes {
 public:
  void add(JobEventRow row);

  /// All of them, in order; none are left.
  std::vector<JobEventRow> take();

 private:
  std::vector<JobEventRow> rows_;
  long forgotten_ = 0;
};

}  // namespace biotomy::acquisition
