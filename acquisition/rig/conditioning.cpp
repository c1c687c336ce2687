#include "acquisition/rig/conditioning.hpp"

#include <algorithm>
#include <array>
#include <cstdio>

namespace biotomy::acquisition {

Conditioning::Conditioning(const SafetyLimits& limits) : limits_(limits) {}

void Conditioning::begin(TimePoint now) {
  inside_since_.reset();
  nearest_.reset();
  progress_at_ = now;
}

double Conditioning::distance(double block_c) const {
  return std::max({0.0, limits_.block_temperature_minimum_c - block_c,
                   block_c - limits_.block_temperature_maximum_c});
}

bool Conditioning::poll(const bridge::StageStatus& status, TimePoint now) {
  // A block that was inside from the start has nothing to settle.
  const bool first = !nearest_;
  block_c_ = status.block_temperature_c;
  const double away = distance(block_c_);
  if (first || away <= *nearest_ - limits_.conditioning_progress_c) {
    nearest_ = away;
    progress_at_ = now;
  }
  if (away == 0.0) {
    if (first) return true;
    if (!inside_since_) inside_since_ = now;
    progress_at_ = now;
    return now - *inside_since_ >= limits_.temperature_delay;
  }
  inside_since_.reset();
  if (now - progress_at_ > limits_.conditioning_progress_time) {
    throw StepFailure("the block does not come nearer to its temperature: it " + waiting_for() +
                      "; look at the cooling");
  }
  return false;
}

std::string Conditioning::waiting_for() const {
  std::array<char, 160> text{};
  std::snprintf(text.data(), text.size(),
                "waits for the block, at %.1f °C, to be at %.1f to %.1f °C", block_c_,
                limits_.block_temperature_minimum_c, limits_.block_temperature_maximum_c);
  return text.data();
}

}  // namespace biotomy::acquisition
