#pragma once

#include <chrono>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "acquisition/rig/step_failure.hpp"
#include "acquisition/service/notifications/notice.hpp"

namespace biotomy::acquisition {

/// Folds repeated troubles together. The first of a cause is told at once; the same again within
/// the window after it is counted, and told in one message at the window's end, with the count and
/// whether it is over by then. Two texts that differ in their numbers alone are one cause. The end
/// of a trouble that was told is told, too. One thread uses it.
class NoticeFold {
 public:
  explicit NoticeFold(std::chrono::milliseconds window);

  /// What is to be sent now of this notice; nothing when it is only counted.
  std::optional<Notice> take(const Notice& notice, TimePoint now);

  /// What was counted and whose window has ended; all that was counted when the daemon ends.
  std::vector<Notice> due(TimePoint now, bool daemon_ends = false);

  /// When `due` should be asked next; nothing when nothing was counted.
  std::optional<TimePoint> next_due() const;

 private:
  struct Cause {
    TimePoint told{};
    long counted = 0;  ///< since then
    bool open = false;
    Notice last;
  };
  void forget_old(TimePoint now);

  std::chrono::milliseconds window_;
  std::map<std::string, Cause> causes_;
};

}  // namespace biotomy::acquisition
