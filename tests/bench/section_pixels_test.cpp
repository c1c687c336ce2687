#include "tests/bench/section_pixels.hpp"

#include <gmock/gmock.h>

namespace biotomy::bench {
namespace {

using reconstruct::Cuboid;
using reconstruct::PyramidLevel;
using reconstruct::Vector3;
using testing::ElementsAre;
using testing::SizeIs;

const Cuboid kBlock{{100, 80, 60}, {10.0, 10.0, 20.0}};
constexpr std::array<int, 3> kChunk{32, 32, 32};
constexpr double kPixel = 10.0;
const PyramidLevel kFinest = reconstruct::pyramid_level(kBlock, {});

NamedPlane along_layers(double z) {
  return {"layer", {{{0, 0, z}, {50, 0, z}, {0, 50, z}}}};
}

TEST(SectionPixels, OfALayerAreItsVoxels) {
  const SectionPixels pixels = section_pixels(along_layers(7), kBlock, kPixel);
  EXPECT_EQ(pixels.columns, 100);
  EXPECT_EQ(pixels.rows, 80);
  EXPECT_EQ(pixels.voxel(99, 79), (Vector3{99, 79, 7}));
}

TEST(SectionPixels, OfAPlaneAcrossTheLayersFollowTheSpacing) {
  const NamedPlane across{"xz", {{{0, 40, 0}, {50, 40, 0}, {0, 40, 50}}}};
  const SectionPixels pixels = section_pixels(across, kBlock, kPixel);
  EXPECT_EQ(pixels.columns, 100);
  EXPECT_EQ(pixels.rows, 119);  // 59 layers of two pixels, and the first
  EXPECT_DOUBLE_EQ(pixels.voxel(3, 5).z, 2.5);
}

TEST(SectionPixels, AreInsideUpToTheBorder) {
  const SectionPixels pixels = section_pixels(along_layers(0), kBlock, kPixel);
  EXPECT_TRUE(pixels.inside({99.0, 79.0, 59.0}, 1e-6));
  EXPECT_FALSE(pixels.inside({99.1, 79.0, 59.0}, 1e-6));
  EXPECT_FALSE(pixels.inside({99.0, 79.0, -0.1}, 1e-6));
  EXPECT_FALSE(pixels.inside({99.0, 79.0, 59.0}, -1e-3));
}

TEST(TouchedChunks, OfALayerAreThoseThatHoldIt) {
  const SectionPixels pixels = section_pixels(along_layers(31), kBlock, kPixel);
  const auto chunks = touched_chunks(pixels, kFinest, kChunk, 1);
  ASSERT_THAT(chunks, SizeIs(4 * 3));
  EXPECT_EQ(chunks.front(), (ChunkPlace{0, 0, 0}));
  EXPECT_EQ(chunks.back(), (ChunkPlace{0, 2, 3}));
}

TEST(TouchedChunks, BetweenTwoLayersAreThoseOfBoth) {
  const SectionPixels pixels = section_pixels(along_layers(31.5), kBlock, kPixel);
  EXPECT_THAT(touched_chunks(pixels, kFinest, kChunk, 1), SizeIs(2 * 4 * 3));
}

TEST(TouchedChunks, ReachFurtherForAWiderKernel) {
  const SectionPixels pixels = section_pixels(along_layers(30.5), kBlock, kPixel);
  EXPECT_THAT(touched_chunks(pixels, kFinest, kChunk, 1), SizeIs(4 * 3));
  EXPECT_THAT(touched_chunks(pixels, kFinest, kChunk, 2), SizeIs(2 * 4 * 3));
}

TEST(TouchedChunks, OfACornerAreOneChunk) {
  const NamedPlane corner{"corner", {{{9, 0, 0}, {0, 9, 0}, {0, 0, 4.5}}}};
  EXPECT_THAT(touched_chunks(section_pixels(corner, kBlock, kPixel), kFinest, kChunk, 1),
              ElementsAre(ChunkPlace{0, 0, 0}));
}

TEST(TouchedChunks, OfACoarseLevelAreCountedAmongItsVoxels) {
  const PyramidLevel coarse = reconstruct::pyramid_level(kBlock, {2, 2, 1});  // 50 x 40 x 60
  const SectionPixels pixels = section_pixels(along_layers(40), kBlock, 2 * kPixel);
  const auto chunks = touched_chunks(pixels, coarse, kChunk, 1);
  ASSERT_THAT(chunks, SizeIs(2 * 2));
  EXPECT_EQ(chunks.front(), (ChunkPlace{1, 0, 0}));
}

}  // namespace
}  // namespace biotomy::bench
