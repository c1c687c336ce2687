#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <memory>
#include <random>

#include <gtest/gtest.h>

#include "reconstruct/bricks/texel_blocks.hpp"
#include "reconstruct/bricks/texel_kernels.hpp"
#include "reconstruct/bricks/texel_kernels_scalar.hpp"
#include "tests/reconstruct/bricks/vector_widths.hpp"

namespace biotomy::reconstruct {
namespace {

template <typename Level>
class MixingKernels : public testing::Test {};

using BothDepths = testing::Types<std::uint8_t, std::uint16_t>;
TYPED_TEST_SUITE(MixingKernels, BothDepths);

/// Bytes in a buffer of just their number: AddressSanitizer finds who reads or writes one more.
struct ExactBytes {
  std::size_t size;
  std::unique_ptr<std::byte[]> bytes = std::make_unique<std::byte[]>(size);

  explicit ExactBytes(std::size_t count) : size(count) {}
};

/// A brick of noise with its slack, and nothing behind it.
template <typename Level>
struct NoisyBrick {
  std::array<int, 3> shape;  // z, y, x
  TexelBlocks blocks{shape, 8 * static_cast<int>(sizeof(Level))};
  ExactBytes memory{blocks.brick_bytes() + TexelBlocks::slack()};

  NoisyBrick(const std::array<int, 3>& zyx, std::mt19937& random) : shape(zyx) {
    ExactBytes voxels(static_cast<std::size_t>(shape[0] * shape[1] * shape[2]) * 3 * sizeof(Level));
    for (std::size_t i = 0; i < voxels.size; ++i) {
      // Extreme levels are where arithmetic overflows.
      const auto value = random() % 4 == 0 ? (random() % 2 == 0 ? 0U : 255U) : random();
      voxels.bytes[i] = static_cast<std::byte>(value & 255U);
    }
    blocks.lay_out({voxels.bytes.get(), voxels.size}, memory.bytes.get());
  }

  const std::byte* texels() const { return memory.bytes.get(); }
  int side(std::size_t axis) const { return shape[2 - axis]; }
};

constexpr std::array<int, 3> kShape{6, 11, 13};

/// Places of random texels of two bricks, with random parts, some at their ends.
enum class Layers { of_one_brick, of_two, many };
constexpr std::array kAllLayers{Layers::of_one_brick, Layers::of_two, Layers::many};

template <typename Level>
PixelPlaces<Level> random_places(const NoisyBrick<Level>& upper, const NoisyBrick<Level>& lower,
                                 std::size_t count, Layers layers, std::mt19937& random) {
  const bool crosses = layers != Layers::of_one_brick;
  PixelPlaces<Level> places;
  places.resize(count);
  places.crosses = crosses;
  places.in_a_layer = layers != Layers::many;
  places.down = upper.blocks.layer_bytes();
  for (std::size_t i = 0; i < count + kRoomPixels; ++i) {
    const auto along = [&](std::size_t axis, int neighbours) {
      const auto texels = static_cast<unsigned>(upper.side(axis) - neighbours);
      return upper.blocks.along(axis, static_cast<int>(random() % texels));
    };
    // Without a brick below the layers go as far as the last but one; the pair begins anywhere.
    const int place = along(0, 0) + along(1, 0) + along(2, crosses ? 0 : 1);
    const int next = along(0, 0) + along(1, 0) + along(2, crosses ? 0 : 1);
    places.upper[0][i] = upper.texels() + place;
    places.upper[1][i] = upper.texels() + next;
    places.lower[0][i] = lower.texels() + place;
    places.lower[1][i] = lower.texels() + next;
    for (auto* parts : {&places.x, &places.y, &places.z}) {
      const std::array<float, 4> values{0.0F, 0x1.fffffep-1F, 0.5F,
                                        static_cast<float>(random() % 100'000) / 100'000.0F};
      (*parts)[i] = PixelPlaces<Level>::part(values[random() % 4]);
    }
  }
  return places;
}

/// Room for just so many pixels: AddressSanitizer finds who writes more, and so do two levels
/// behind them that must stay.
template <typename Level>
struct Pixels {
  static constexpr Level kUntouched = 77;
  std::size_t count;
  std::unique_ptr<Level[]> levels = std::make_unique<Level[]>(3 * count + 2);

  explicit Pixels(std::size_t pixels) : count(pixels) {
    std::fill_n(levels.get(), 3 * count + 2, kUntouched);
  }

  bool is_untouched_behind() const {
    return levels[3 * count] == kUntouched && levels[3 * count + 1] == kUntouched;
  }
};

TYPED_TEST(MixingKernels, MixLinearlyAsTheScalarOnesDo) {
  using Level = TypeParam;
  for_each_vector_width([] {
    constexpr int kOff = sizeof(Level) == 1 ? 0 : 1;  // 8 bits: to the bit
    std::mt19937 random(3);
    const NoisyBrick<Level> upper(kShape, random);
    const NoisyBrick<Level> lower(kShape, random);
    for (std::size_t count = 1; count <= 300; count += count < 40 ? 1 : 13) {
      for (const Layers layers : kAllLayers) {
        const PixelPlaces<Level> places = random_places(upper, lower, count, layers, random);
        Pixels<Level> got(count);
        Pixels<Level> wanted(count);
        mix_linear(places, count, {}, got.levels.get());
        scalar::mix_linear(places, count, {}, wanted.levels.get());
        for (std::size_t i = 0; i < 3 * count; ++i) {
          ASSERT_LE(std::abs(got.levels[i] - wanted.levels[i]), kOff) << i << " of " << count;
        }
        ASSERT_TRUE(got.is_untouched_behind());
      }
    }
  });
}

TYPED_TEST(MixingKernels, MixStraightRunsAsTheScalarOnesDoAndNothingElse) {
  using Level = TypeParam;
  for_each_vector_width([] {
    constexpr int kOff = sizeof(Level) == 1 ? 0 : 1;  // 8 bits: to the bit
    std::mt19937 random(9);
    const NoisyBrick<Level> upper(kShape, random);
    const NoisyBrick<Level> lower(kShape, random);
    const auto texels = static_cast<std::size_t>(upper.side(0));
    for (std::size_t first = 0; first < texels; ++first) {
      for (std::size_t count = 1; count <= texels - first; ++count) {
        const auto row_of = [&](const NoisyBrick<Level>& brick) {
          return brick.texels() + brick.blocks.along_y(static_cast<int>(random() % 11)) +
                 brick.blocks.along_z(static_cast<int>(random() % 6));
        };
        const StraightRun run{
            {row_of(upper), row_of(upper)}, {row_of(lower), row_of(lower)}, first, count};
        const auto part = [&] {
          const std::array<float, 3> values{0.0F, 0x1.fffffep-1F,
                                            static_cast<float>(random() % 1000) / 1000.0F};
          return PixelPlaces<Level>::part(values[random() % 3]);
        };
        const StraightParts<Level> parts{part(), part()};
        const auto got = std::make_unique<Level[]>(3 * count);  // no room behind the last pixel
        const auto wanted = std::make_unique<Level[]>(3 * count);
        mix_straight(run, parts, got.get());
        scalar::mix_straight(run, parts, wanted.get());
        for (std::size_t i = 0; i < 3 * count; ++i) {
          ASSERT_LE(std::abs(got[i] - wanted[i]), kOff) << i << " of " << count;
        }
      }
    }
  });
}

// The scalar kernels against the definition, so that what the others are held against is right.
TYPED_TEST(MixingKernels, MixLinearlyWithinALevelOfExactArithmetic) {
  using Level = TypeParam;
  for_each_vector_width([] {
    std::mt19937 random(4);
    const NoisyBrick<Level> upper(kShape, random);
    const NoisyBrick<Level> lower(kShape, random);
    constexpr std::size_t kCount = 1000;
    const double unit = sizeof(Level) == 1 ? 65536.0 : 1.0;
    for (const Layers layers : kAllLayers) {
      const PixelPlaces<Level> places = random_places(upper, lower, kCount, layers, random);
      Pixels<Level> got(kCount);
      mix_linear(places, kCount, {}, got.levels.get());
      for (std::size_t i = 0; i < kCount; ++i) {
        for (int colour = 0; colour < 3; ++colour) {
          double sum = 0.0;
          for (std::size_t row = 0; row < 2; ++row) {
            for (int x = 0; x < 2; ++x) {
              const std::byte* above = places.upper[row][i];
              const std::byte* below = places.below(row, i);
              const double z = places.z[places.in_a_layer ? 0 : i] / unit;
              const double y = places.y[i] / unit;
              const double weight_x = x == 0 ? 1.0 - places.x[i] / unit : places.x[i] / unit;
              sum += (row == 0 ? 1.0 - y : y) * weight_x *
                     ((1.0 - z) * scalar::level_at<Level>(above, 3 * x + colour) +
                      z * scalar::level_at<Level>(below, 3 * x + colour));
            }
          }
          ASSERT_NEAR(got.levels[3 * i + static_cast<std::size_t>(colour)], sum,
                      0.5 + (sizeof(Level) == 1 ? 0.03 : 0.04));
        }
      }
    }
  });
}

TYPED_TEST(MixingKernels, GiveAVoxelsOwnColourAtItsCentre) {
  using Level = TypeParam;
  for_each_vector_width([] {
    std::mt19937 random(5);
    const NoisyBrick<Level> brick(kShape, random);
    constexpr std::size_t kCount = 500;
    PixelPlaces<Level> places = random_places(brick, brick, kCount, Layers::many, random);
    for (auto* parts : {&places.x, &places.y, &places.z}) {
      std::fill(parts->begin(), parts->end(), typename PixelPlaces<Level>::Part{0});
    }
    Pixels<Level> got(kCount);
    mix_linear(places, kCount, {}, got.levels.get());
    for (std::size_t i = 0; i < kCount; ++i) {
      for (int colour = 0; colour < 3; ++colour) {
        ASSERT_EQ(got.levels[3 * i + static_cast<std::size_t>(colour)],
                  scalar::level_at<Level>(places.upper[0][i], colour));
      }
    }
  });
}

/// The exact colour at `part` between 4³ texels; what the kernel clamps is not clamped yet.
template <typename Level>
double exact_cubic(const std::array<Level, 256>& texels, const std::array<float, 3>& part,
                   std::size_t colour) {
  std::array<std::array<double, 4>, 3> weights{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double t = part[axis];
    for (int i = 0; i < 4; ++i) {  // Keys 1981, equation 15: u is the distance to the texel
      const double u = std::abs(t + 1.0 - i);
      weights[axis][static_cast<std::size_t>(i)] =
          u < 1.0 ? 1.5 * u * u * u - 2.5 * u * u + 1.0
                  : (u < 2.0 ? -0.5 * u * u * u + 2.5 * u * u - 4.0 * u + 2.0 : 0.0);
    }
  }
  double sum = 0.0;
  for (std::size_t i = 0; i < 64; ++i) {
    sum += weights[0][i % 4] * weights[1][i / 4 % 4] * weights[2][i / 16] * texels[4 * i + colour];
  }
  return sum;
}

TYPED_TEST(MixingKernels, MixCubicallyAsTheScalarOnesAndExactArithmeticDo) {
  using Level = TypeParam;
  for_each_vector_width([] {
    constexpr double kMost = std::numeric_limits<Level>::max();
    std::mt19937 random(6);
    int clamped = 0;
    for (int round = 0; round < 1000; ++round) {
      std::array<Level, 256> texels{};
      for (Level& level : texels) {
        level = static_cast<Level>(round % 2 == 0 ? random() : (random() % 2) * 65535);
      }
      std::array<float, 3> part{};
      for (float& each : part) {
        each = random() % 5 == 0 ? 0.0F : static_cast<float>(random() % 1000) / 1000.0F;
      }
      std::array<Level, 4> got{};
      std::array<Level, 4> wanted{};
      mix_cubic(texels.data(), part, got.data());
      scalar::mix_cubic(texels.data(), part, wanted.data());
      for (std::size_t colour = 0; colour < 3; ++colour) {
        const double exact = exact_cubic(texels, part, colour);
        clamped += exact < 0.0 || exact > kMost ? 1 : 0;
        ASSERT_LE(std::abs(got[colour] - wanted[colour]), 1);
        ASSERT_NEAR(got[colour], std::clamp(exact, 0.0, kMost), 0.6);
      }
    }
    EXPECT_GT(clamped, 10);
  });
}

TYPED_TEST(MixingKernels, ReadNothingBehindABricksSlack) {
  using Level = TypeParam;
  for_each_vector_width([] {
    std::mt19937 random(8);
    for (const auto& shape : {kShape, std::array<int, 3>{1, 1, 1}, std::array<int, 3>{1, 8, 4},
                              std::array<int, 3>{3, 2, 5}}) {
      const NoisyBrick<Level> brick(shape, random);
      // The last texel of all: what stands where its neighbours would be weighs nothing.
      const std::byte* const last = brick.texels() + brick.blocks.along_x(shape[2] - 1) +
                                    brick.blocks.along_y(shape[1] - 1) +
                                    brick.blocks.along_z(shape[0] - 1);
      PixelPlaces<Level> places;
      places.resize(5);
      places.in_a_layer = true;
      for (auto& row : places.upper) {
        std::fill(row.begin(), row.end(), last);
      }
      Pixels<Level> got(5);
      mix_linear(places, 5, {}, got.levels.get());
      for (std::size_t i = 0; i < 5; ++i) {
        for (int colour = 0; colour < 3; ++colour) {
          ASSERT_EQ(got.levels[3 * i + static_cast<std::size_t>(colour)],
                    scalar::level_at<Level>(last, colour));
        }
      }
    }
  });
}

}  // namespace
}  // namespace biotomy::reconstruct
