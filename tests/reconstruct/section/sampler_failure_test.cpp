// A source that fails while other threads find out what they will need of it.
#include <atomic>
#include <chrono>
#include <cstdint>
#include <stdexcept>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "reconstruct/section/sampler.hpp"
#include "tests/reconstruct/section/sampler_reference.hpp"

namespace biotomy::reconstruct {
namespace {

using namespace std::chrono_literals;

/// Gives the first strip. From then on planning takes long; of the second strip it throws, once
/// tiles further down are being planned.
struct SourceThatFailsLater final : BrickSource {
  tests::MemorySource volume;
  std::atomic<int> fetches{0};
  std::atomic<bool> is_failing{false};
  mutable std::atomic<bool> is_planned{false};

  const Cuboid& cuboid() const override { return volume.cuboid(); }
  std::array<int, 3> brick_shape() const override {
    is_planned = is_planned || is_failing;
    if (fetches > 0) {
      std::this_thread::sleep_for(2ms);
    }
    return volume.brick_shape();
  }
  int bits() const override { return volume.bits(); }
  int levels() const override { return volume.levels(); }
  const PyramidLevel& level(int number) const override { return volume.level(number); }
  std::int64_t layers_present() const override { return volume.layers_present(); }
  std::size_t capacity_bytes() const override { return volume.capacity_bytes(); }
  void expect(int, std::span<const ChunkIndex>, const PlaneReach&) override {}

  std::vector<TexelBrick> bricks(int level, std::span<const ChunkIndex> wanted,
                                 const PlaneReach& plane) override {
    if (++fetches == 1) {
      return volume.bricks(level, wanted, plane);
    }
    is_failing = true;
    for (int i = 0; i < 1000 && !is_planned; ++i) {
      std::this_thread::sleep_for(1ms);
    }
    throw std::runtime_error("a chunk is damaged");
  }
};

TEST(SamplerOfASourceThatFails, PassesOnWhatItThrowsWhileStripsAreBeingPlanned) {
  for (int round = 0; round < 5; ++round) {
    SourceThatFailsLater source;
    source.volume.box = {{12000, 1200, 2}, {10.0, 10.0, 10.0}};
    source.volume.chunk_size = {2, 64, 64};
    const Plane plane = Plane::from_normal({0, 0, 1}, {0, 0, 10.0});
    const PixelGrid grid = tests::grid_for(plane, source.volume.box, 10.0);
    EXPECT_THROW(sample_grid(source, grid, Interpolation::linear, tests::kBackground),
                 std::runtime_error);
    EXPECT_TRUE(source.is_planned) << "nothing was planned meanwhile, so this shows nothing";
  }
}

}  // namespace
}  // namespace biotomy::reconstruct
