#include "reconstruct/bricks/texel_kernels.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <functional>
#include <iostream>
#include <limits>
#include <memory>
#include <random>
#include <set>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "reconstruct/bricks/texel_blocks.hpp"
#include "reconstruct/bricks/texel_kernels_scalar.hpp"
#include "reconstruct/bricks/vector_targets.hpp"
#include "tests/reconstruct/bricks/random_path.hpp"

namespace biotomy::reconstruct {
namespace {

template <typename Level>
class TexelKernels : public testing::Test {};

using BothDepths = testing::Types<std::uint8_t, std::uint16_t>;
TYPED_TEST_SUITE(TexelKernels, BothDepths);

/// Lets the kernels run on vectors of one width, whatever this processor's widest is.
class VectorWidth {
 public:
  explicit VectorWidth(std::int64_t target) { hwy::SetSupportedTargetsForTest(target); }
  ~VectorWidth() { hwy::SetSupportedTargetsForTest(0); }
  VectorWidth(const VectorWidth&) = delete;
  VectorWidth& operator=(const VectorWidth&) = delete;
};

/// Each width that was compiled and that this processor has; the report says which they were.
void for_each_vector_width(const std::function<void()>& check) {
  std::string names;
  for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
    SCOPED_TRACE(hwy::TargetName(target));
    const VectorWidth width(target);
    check();
    names += std::string(names.empty() ? "" : " ") + hwy::TargetName(target);
  }
  EXPECT_FALSE(names.empty());
  std::cout << "on " << names << '\n';
}

#if HWY_ARCH_ARM_A64
// Where the compiler or the processor had no NEON, the kernels would run all the same, slowly.
TEST(TexelKernelTargets, AreNeonOn64BitArm) {
  std::vector<std::string> names;
  for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
    names.emplace_back(hwy::TargetName(target));
  }
  EXPECT_THAT(names, testing::Contains(testing::StartsWith("NEON")));
}
#endif

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

/// How many bricks the box has that a path leads through.
int slots_of(const RowPath& path) {
  const auto& [x, y, z] = path.axes;
  return path.slot(x.last / x.side, y.last / y.side, z.last / z.side) + 1;
}

/// A path through a box that makes a small table.
RowPath random_short_path(int count, std::mt19937& random) {
  for (;;) {
    const RowPath path = tests::random_path(count, random);
    if (slots_of(path) < 50'000) {
      return path;
    }
  }
}

/// Bricks that are only told apart, each so far from the next that no place belongs to two.
std::vector<const std::byte*> distant_bricks(int count) {
  constexpr std::uintptr_t kFar = std::uintptr_t{1} << 32U;
  std::vector<const std::byte*> bricks;
  for (int slot = 1; slot <= count; ++slot) {
    bricks.push_back(reinterpret_cast<const std::byte*>(static_cast<unsigned>(slot) * kFar));
  }
  return bricks;
}

template <typename Level>
void expect_same_places(const PixelPlaces<Level>& got, const PixelPlaces<Level>& wanted,
                        std::size_t count) {
  ASSERT_EQ(got.crosses, wanted.crosses);
  ASSERT_EQ(got.in_a_layer, wanted.in_a_layer);
  ASSERT_EQ(got.down, wanted.down);
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t row = 0; row < 2; ++row) {
      ASSERT_EQ(got.upper[row][i], wanted.upper[row][i]) << i << " of " << count;
      ASSERT_EQ(got.below(row, i), wanted.below(row, i)) << i << " of " << count;
    }
    ASSERT_EQ(got.x[i], wanted.x[i]);
    ASSERT_EQ(got.y[i], wanted.y[i]);
    if (i == 0 || !wanted.in_a_layer) {
      ASSERT_EQ(got.z[i], wanted.z[i]);
    }
  }
  ASSERT_EQ(got.parted_count, wanted.parted_count);
  for (std::size_t i = 0; i < wanted.parted_count; ++i) {
    ASSERT_EQ(got.parted[i].pixel, wanted.parted[i].pixel);
    ASSERT_EQ(got.parted[i].upper, wanted.parted[i].upper);
    ASSERT_EQ(got.parted[i].lower, wanted.parted[i].lower);
  }
}

TYPED_TEST(TexelKernels, PlaceRowsAsTheScalarOnesDo) {
  using Level = TypeParam;
  std::size_t parted = 0;
  std::array<int, 3> layers{};
  for_each_vector_width([&] {
    std::mt19937 random(2);
    for (int round = 0; round < 8; ++round) {
      for (int count = 1; count <= kMostPixels; ++count) {
        const RowPath path = random_short_path(count, random);
        const std::vector<const std::byte*> bricks = distant_bricks(slots_of(path));
        PixelPlaces<Level> got;
        got.resize(static_cast<std::size_t>(count));
        PixelPlaces<Level> wanted = got;
        place_row(path, count, bricks.data(), got);
        scalar::place_row(path, count, bricks.data(), wanted);
        expect_same_places(got, wanted, static_cast<std::size_t>(count));
        if (testing::Test::HasFatalFailure()) {
          return;
        }
        parted += wanted.parted_count;
        layers[wanted.in_a_layer ? (wanted.crosses ? 1 : 0) : 2] += 1;
      }
    }
  });
  EXPECT_GT(parted, 10'000U);
  for (const int rows : layers) {
    EXPECT_GT(rows, 20);
  }
}

// The table ends with the last pixel's brick: AddressSanitizer finds who looks further for what
// stands in the room.
TYPED_TEST(TexelKernels, LookUpNoBrickBehindTheLastPixels) {
  using Level = TypeParam;
  for_each_vector_width([] {
    RowPath path;
    path.block_row_bytes = 64;
    path.layer_bytes = 320;
    for (RowAxis& axis : path.axes) {
      axis.side = 4;
      axis.last = 1000;
    }
    path.axes[0].step = path.axes[0].side << kFractionBits;
    for (int count = 1; count < 40; ++count) {
      const auto bricks = std::make_unique<const std::byte*[]>(static_cast<std::size_t>(count));
      const std::vector<const std::byte*> distant = distant_bricks(count);
      std::copy(distant.begin(), distant.end(), bricks.get());
      PixelPlaces<Level> places;
      places.resize(static_cast<std::size_t>(count));
      place_row(path, count, bricks.get(), places);
      const auto last = static_cast<std::size_t>(count) - 1;
      ASSERT_EQ(places.upper[0][last], distant.back());
    }
  });
}

/// The slots of all bricks that a kernel finds.
using FindBricks = std::size_t(const RowPath&, int, std::int32_t*);
std::set<int> bricks_found(FindBricks& find, const RowPath& path, int count) {
  const auto numbers = std::make_unique<std::int32_t[]>(kFoundRoom);
  const std::size_t total = find(path, count, numbers.get());
  std::set<int> slots;
  for (std::size_t i = 0; i < total; ++i) {
    const SupportBricks bricks = SupportBricks::of(numbers[i]);
    for (unsigned corner = 0; corner < 8; ++corner) {
      if ((corner & ~bricks.further) == 0) {
        slots.insert(bricks.slot + path.slot(static_cast<int>(corner & 1U),
                                             static_cast<int>(corner >> 1U & 1U),
                                             static_cast<int>(corner >> 2U)));
      }
    }
  }
  return slots;
}

TEST(BricksOfARow, AreFoundAsTheScalarKernelFindsThem) {
  std::size_t found = 0;
  for_each_vector_width([&] {
    std::mt19937 random(12);
    for (int round = 0; round < 8; ++round) {
      for (int count = 1; count <= kMostPixels; ++count) {
        const RowPath path = tests::random_path(count, random);
        const std::set<int> got = bricks_found(find_bricks, path, count);
        const std::set<int> wanted = bricks_found(scalar::find_bricks, path, count);
        ASSERT_EQ(got, wanted) << count;
        found += wanted.size();
      }
    }
  });
  EXPECT_GT(found, 10'000U);
}

// A tile's rows may lie far apart, where pixels are large and there is no coarser level.
TEST(BricksOfARow, AreFoundFarFromTheBoxsFirst) {
  for_each_vector_width([] {
    std::mt19937 random(14);
    for (int round = 0; round < 20; ++round) {
      for (int count = 1; count <= kMostPixels; ++count) {
        RowPath path = tests::random_path(count, random);
        RowAxis& far = path.axes[random() % 3];
        for (RowAxis& axis : path.axes) {
          axis.slot_stride = &axis == &far ? 1 : 0;
        }
        far.side = random() % 2 == 0 ? far.side : 100 + static_cast<int>(random() % 100'000);
        const int shift = static_cast<int>(random() % 4'000'000);
        far.base += shift;
        far.first += shift;
        far.last += shift;
        const std::set<int> got = bricks_found(find_bricks, path, count);
        const std::set<int> wanted = bricks_found(scalar::find_bricks, path, count);
        ASSERT_EQ(got, wanted) << count << " pixels, bricks of " << far.side;
      }
    }
  });
}

TEST(BricksOfARow, AreThoseOfEachOfItsPixels) {
  std::mt19937 random(13);
  for (int count = 1; count <= kMostPixels; ++count) {
    const RowPath path = tests::random_path(count, random);
    std::vector<std::int32_t> found(kFoundRoom);
    found.resize(scalar::find_bricks(path, count, found.data()));
    std::size_t at = 0;
    for (int pixel = 0; pixel < count; ++pixel) {
      SupportBricks bricks;
      for (unsigned axis = 0; axis < 3; ++axis) {
        const AxisPlace place(path.axes[axis], pixel);
        bricks.slot += place.near_brick * path.axes[axis].slot_stride;
        bricks.further |= place.far_brick != place.near_brick ? 1U << axis : 0U;
      }
      at += found[at] != bricks.number() ? 1 : 0;
      ASSERT_LT(at, found.size());
      ASSERT_EQ(found[at], bricks.number()) << pixel << " of " << count;
    }
    ASSERT_EQ(at, found.size() - 1);
  }
}

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

TYPED_TEST(TexelKernels, MixLinearlyAsTheScalarOnesDo) {
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

TYPED_TEST(TexelKernels, MixStraightRunsAsTheScalarOnesDoAndNothingElse) {
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
TYPED_TEST(TexelKernels, MixLinearlyWithinALevelOfExactArithmetic) {
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

TYPED_TEST(TexelKernels, GiveAVoxelsOwnColourAtItsCentre) {
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

TYPED_TEST(TexelKernels, MixCubicallyAsTheScalarOnesAndExactArithmeticDo) {
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

TYPED_TEST(TexelKernels, ReadNothingBehindABricksSlack) {
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
