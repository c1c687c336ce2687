#include "tools/progress_bar.hpp"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <iostream>
#include <sstream>
#include <utility>

#include <unistd.h>

namespace biotomy::tools {
namespace {

using Seconds = std::chrono::duration<double>;

constexpr Seconds kSilence{1.0};
constexpr Seconds kBetweenDrawings{0.1};
constexpr std::int64_t kWidth = 30;
constexpr const char* kStartOfLine = "\r\x1b[K";  // carriage return, erase to the end of the line

std::string time_left(double seconds) {
  const auto whole = static_cast<std::int64_t>(std::llround(seconds));
  std::ostringstream text;
  text << std::setfill('0');
  if (whole >= 3600) {
    text << whole / 3600 << ':' << std::setw(2);
  }
  text << whole / 60 % 60 << ':' << std::setw(2) << whole % 60;
  return text.str();
}

}  // namespace

ProgressBar::ProgressBar(std::string what, std::string unit)
    : ProgressBar(std::move(what), std::move(unit), std::cerr, ::isatty(STDERR_FILENO) == 1,
                  Clock::now) {}

ProgressBar::ProgressBar(std::string what, std::string unit, std::ostream& out, bool terminal,
                         Now now)
    : what_(std::move(what)),
      unit_(std::move(unit)),
      out_(out),
      terminal_(terminal),
      now_(std::move(now)),
      start_(now_()),
      drawn_(start_) {}

ProgressBar::~ProgressBar() {
  if (visible_) {
    out_ << kStartOfLine << std::flush;
  }
}

void ProgressBar::update(std::int64_t done, std::int64_t total) {
  const Clock::time_point now = now_();
  const double elapsed = Seconds(now - start_).count();
  if (!terminal_ || done < 1 || total < 1 || Seconds(now - start_) < kSilence ||
      (visible_ && Seconds(now - drawn_) < kBetweenDrawings)) {
    return;
  }
  visible_ = true;
  drawn_ = now;
  const std::int64_t shown = std::min(done, total);
  const std::int64_t filled = shown * kWidth / total;
  const double rate = static_cast<double>(shown) / elapsed;
  std::ostringstream line;
  line << kStartOfLine << what_ << " [" << std::string(static_cast<std::size_t>(filled), '#')
       << std::string(static_cast<std::size_t>(kWidth - filled), '.') << "] " << shown << '/'
       << total << ' ' << unit_ << ", " << std::fixed << std::setprecision(rate < 10 ? 1 : 0)
       << rate << "/s, " << time_left(static_cast<double>(total - shown) / rate) << " left";
  out_ << line.str() << std::flush;
}

}  // namespace biotomy::tools
