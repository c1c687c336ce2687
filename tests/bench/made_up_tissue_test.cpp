#include "tests/bench/made_up_tissue.hpp"

#include <set>
#include <vector>

#include <gtest/gtest.h>

#include "reconstruct/errors.hpp"

namespace biotomy::bench {
namespace {

TEST(MadeUpTissue, IsTheSameByRowsAndByVoxels) {
  const MadeUpTissue tissue(0.3);
  std::vector<std::uint8_t> row(3 * 100);
  tissue.row(13, 4321, 999, 100, row.data());
  for (std::int64_t i = 0; i < 100; ++i) {
    const auto voxel = tissue.voxel(13 + i, 4321, 999);
    for (std::size_t c = 0; c < 3; ++c) {
      ASSERT_EQ(row[static_cast<std::size_t>(3 * i) + c], voxel[c]) << i;
    }
  }
}

TEST(MadeUpTissue, HasNoiseAtTheShareOfItsVoxels) {
  constexpr std::int64_t kVoxels = 100'000;
  std::vector<std::uint8_t> quiet(3 * kVoxels);
  std::vector<std::uint8_t> noisy(3 * kVoxels);
  MadeUpTissue(0.0).row(0, 5, 7, kVoxels, quiet.data());
  MadeUpTissue(0.25).row(0, 5, 7, kVoxels, noisy.data());
  int differ = 0;
  for (std::size_t i = 0; i < quiet.size(); i += 3) {
    differ += quiet[i] != noisy[i] || quiet[i + 1] != noisy[i + 1] || quiet[i + 2] != noisy[i + 2];
    for (std::size_t c = 0; c < 3; ++c) {
      ASSERT_NEAR(quiet[i + c], noisy[i + c], 5);
    }
  }
  EXPECT_NEAR(differ, 0.25 * kVoxels, 0.03 * kVoxels);  // some of the noise is zero
}

TEST(MadeUpTissue, TellsItsCellsApart) {
  const MadeUpTissue tissue(0.0);
  std::set<std::array<std::uint8_t, 3>> colours;
  for (std::int64_t cell = 0; cell < 50; ++cell) {
    colours.insert(tissue.voxel(24 * cell, 0, 0));
    colours.insert(tissue.voxel(0, 24 * cell + 24, 0));
    colours.insert(tissue.voxel(0, 0, 24 * cell + 24));
  }
  EXPECT_EQ(colours.size(), 150U);
}

TEST(MadeUpTissue, RefusesAShareThatIsNone) {
  EXPECT_THROW(MadeUpTissue(-0.1), reconstruct::InvalidRequest);
  EXPECT_THROW(MadeUpTissue(1.1), reconstruct::InvalidRequest);
}

}  // namespace
}  // namespace biotomy::bench
