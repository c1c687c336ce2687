#include "acquisition/service/refusal_log.hpp"

#include <utility>

namespace biotomy::acquisition {
namespace {

constexpr std::chrono::minutes kMinute{1};
constexpr std::size_t kMostLines = 10;  // a minute

}  // namespace

std::optional<std::string> RefusalLog::line(const std::string& client, const std::string& what,
                                            TimePoint now) {
  if (!minute_ || now - *minute_ >= kMinute) {
    minute_ = now;
    written_.clear();
  }
  std::string text = "refused " + client + ": " + what;
  if (written_.size() >= kMostLines || written_.contains(text)) {
    ++counted_;
    return std::nullopt;
  }
  written_.insert(text);
  if (const long untold = std::exchange(counted_, 0); untold > 0) {
    text += "; " + std::to_string(untold) + " more refusals before it were not written down";
  }
  return text;
}

}  // namespace biotomy::acquisition
