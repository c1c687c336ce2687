#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <random>
#include <set>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "reconstruct/bricks/texel_kernels.hpp"
#include "reconstruct/bricks/texel_kernels_scalar.hpp"
#include "tests/reconstruct/bricks/random_path.hpp"
#include "tests/reconstruct/bricks/vector_widths.hpp"

namespace biotomy::reconstruct {
namespace {

template <typename Level>
class PlacingKernels : public testing::Test {};

using BothDepths = testing::Types<std::uint8_t, std::uint16_t>;
TYPED_TEST_SUITE(PlacingKernels, BothDepths);

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

TYPED_TEST(PlacingKernels, PlaceRowsAsTheScalarOnesDo) {
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
TYPED_TEST(PlacingKernels, LookUpNoBrickBehindTheLastPixels) {
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

}  // namespace
}  // namespace biotomy::reconstruct
