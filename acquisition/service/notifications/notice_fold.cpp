#include "acquisition/service/notifications/notice_fold.hpp"

#include <algorithm>
#include <cctype>

namespace biotomy::acquisition {
namespace {

constexpr std::size_t kMostCauses = 256;

std::string cause_of(const Notice& notice) {
  std::string cause = std::string(to_string(notice.kind)) + ": ";
  for (const char character : notice.text) {
    if (std::isdigit(static_cast<unsigned char>(character)) == 0) cause += character;
  }
  return cause;
}

}  // namespace

NoticeFold::NoticeFold(std::chrono::milliseconds window) : window_(window) {}

std::optional<Notice> NoticeFold::take(const Notice& notice, TimePoint now) {
  if (notice.over) {
    bool tell = false;
    for (auto& [text, cause] : causes_) {
      if (cause.last.kind != notice.kind || !cause.open) continue;
      cause.open = false;
      // What was only counted is told together with its end.
      tell = tell || cause.counted == 0;
    }
    return tell ? std::optional(notice) : std::nullopt;
  }
  forget_old(now);
  const auto [found, is_new] = causes_.try_emplace(cause_of(notice));
  Cause& cause = found->second;
  cause.last = notice;
  cause.open = notice.kind != NoticeKind::done && notice.kind != NoticeKind::test;
  if (!is_new && (cause.counted > 0 || now - cause.told < window_)) {
    ++cause.counted;
    return std::nullopt;
  }
  cause.told = now;
  return notice;
}

std::vector<Notice> NoticeFold::due(TimePoint now, bool daemon_ends) {
  std::vector<Notice> notices;
  for (auto& [text, cause] : causes_) {
    if (cause.counted == 0) continue;
    if (!daemon_ends && now - cause.told < window_) continue;
    Notice summary = cause.last;
    summary.count = cause.counted;
    const auto minutes = std::chrono::ceil<std::chrono::minutes>(now - cause.told).count();
    summary.text += " (" + std::to_string(cause.counted) + " more times within " +
                    std::to_string(minutes) + " min" + (cause.open ? ")" : "; over now)");
    notices.push_back(std::move(summary));
    cause.told = now;
    cause.counted = 0;
  }
  return notices;
}

std::optional<TimePoint> NoticeFold::next_due() const {
  std::optional<TimePoint> next;
  for (const auto& [text, cause] : causes_) {
    if (cause.counted == 0) continue;
    next = std::min(next.value_or(cause.told + window_), cause.told + window_);
  }
  return next;
}

void NoticeFold::forget_old(TimePoint now) {
  std::erase_if(causes_, [&](const auto& entry) {
    const Cause& cause = entry.second;
    return !cause.open && cause.counted == 0 && now - cause.told >= window_;
  });
  if (causes_.size() < kMostCauses) return;
  causes_.erase(std::min_element(causes_.begin(), causes_.end(), [](const auto& a, const auto& b) {
    return a.second.told < b.second.told;
  }));
}

}  // namespace biotomy::acquisition
