#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <ostream>
#include <string>

namespace biotomy::tools {

/// A line on a terminal that tells how far a piece of work is, how fast it goes and how long it
/// will still take. Nothing is drawn during the first second, and never into a pipe or a file.
class ProgressBar {
 public:
  using Clock = std::chrono::steady_clock;
  using Now = std::function<Clock::time_point()>;

  /// On stderr, if that is a terminal.
  ProgressBar(std::string what, std::string unit);

  /// On `out`, whatever it is, if `terminal`.
  ProgressBar(std::string what, std::string unit, std::ostream& out, bool terminal, Now now);

  /// Takes the line away.
  ~ProgressBar();
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

  void update(std::int64_t done, std::int64_t total);

 private:
  std::string what_;
  std::string unit_;
  std::ostream& out_;
  bool terminal_;
  Now now_;
  Clock::time_point start_;
  Clock::time_point drawn_;
  bool visible_ = false;
};

}  // namespace biotomy::tools
