#include "sim/physics/block.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "sim/phantom/gradient_noise.hpp"

namespace biotomy::sim {

namespace {

// Numbers of one seed that must have nothing to do with each other.
constexpr std::uint64_t kWearStream = 0x77656172;
constexpr std::uint64_t kDebrisStream = 0x64656272;

/// Near enough to a standard normal, bounded by ±3: the sum of a dozen fractions, the tails cut.
double bounded_normal(std::uint64_t seed, std::uint64_t index) {
  double sum = -6.0;
  for (std::uint64_t i = 0; i < 12; ++i) {
    sum += mixed_fraction(seed, 12 * index + i);
  }
  return std::clamp(sum, -3.0, 3.0);
}

}  // namespace

Block::Block(std::uint64_t seed, double face_um, double roughness_um, const DebrisSettings& debris)
    : seed_(seed), roughness_um_(roughness_um), debris_(debris), pass_depth_um_(face_um) {
  state_.strip_depth_um.fill(face_um);
}

void Block::begin_pass(double feed_um) {
  pass_depth_um_ = feed_um + roughness_um_ * bounded_normal(seed_ ^ kWearStream, state_.passes);
  ++state_.passes;
  state_.blown_ms = 0;
}

void Block::cut_to(double share) {
  const auto passed = static_cast<std::size_t>(
      std::floor(std::clamp(share, 0.0, 1.0) * static_cast<double>(kStrips)));
  for (std::size_t i = 0; i < passed; ++i) {
    state_.strip_depth_um[i] = std::max(state_.strip_depth_um[i], pass_depth_um_);
  }
}

double Block::shallowest_um() const {
  return *std::ranges::min_element(state_.strip_depth_um);
}

double Block::deepest_um() const {
  return *std::ranges::max_element(state_.strip_depth_um);
}

double Block::mean_um() const {
  return std::accumulate(state_.strip_depth_um.begin(), state_.strip_depth_um.end(), 0.0) /
         static_cast<double>(kStrips);
}

std::vector<Speck> Block::debris() const {
  std::vector<Speck> specks;
  if (state_.passes == 0) {
    return specks;
  }
  for (int i = 0; i < debris_.specks; ++i) {
    const std::uint64_t stream = (seed_ ^ kDebrisStream) + state_.passes;
    const auto fraction = [&](std::uint64_t which) {
      return mixed_fraction(stream, 4 * static_cast<std::uint64_t>(i) + which);
    };
    if (fraction(0) * debris_.hold_ms >= state_.blown_ms) {
      specks.push_back({fraction(1), fraction(2),
                        static_cast<float>(debris_.radius_um) * (0.3F + 0.7F * fraction(3))});
    }
  }
  return specks;
}

}  // namespace biotomy::sim
