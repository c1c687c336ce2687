#include "reconstruct/bricks/texel_kernels.hpp"

#include "reconstruct/bricks/texel_kernels_scalar.hpp"
#include "reconstruct/bricks/vector_targets.hpp"

// Highway compiles this file once for each vector width.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "reconstruct/bricks/texel_kernels.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#if HWY_TARGET != HWY_SCALAR
#include "reconstruct/bricks/cubic_kernel-inl.hpp"
#include "reconstruct/bricks/find_kernel-inl.hpp"
#include "reconstruct/bricks/linear_kernel-inl.hpp"
#include "reconstruct/bricks/place_kernel-inl.hpp"
#include "reconstruct/bricks/straight_kernel-inl.hpp"
#endif

HWY_BEFORE_NAMESPACE();
namespace biotomy::reconstruct::HWY_NAMESPACE {
#if HWY_TARGET == HWY_SCALAR
namespace kernels = scalar;
#else
namespace kernels = HWY_NAMESPACE;
#endif

std::size_t find_bricks_here(const RowPath& path, int count, std::int32_t* found) {
  return kernels::find_bricks(path, count, found);
}
void place_row_8(const RowPath& path, int count, const std::byte* const* bricks,
                 PixelPlaces<std::uint8_t>& places) {
  kernels::place_row(path, count, bricks, places);
}
void mix_linear_8(const PixelPlaces<std::uint8_t>& places, std::size_t count,
                  const PairLines<std::uint8_t>& ahead, std::uint8_t* rgb) {
  kernels::mix_linear(places, count, ahead, rgb);
}
void mix_straight_8(const StraightRun& run, const StraightParts<std::uint8_t>& parts,
                    std::uint8_t* rgb) {
  kernels::mix_straight(run, parts, rgb);
}
void mix_cubic_8(const std::uint8_t* texels, const std::array<float, 3>& part,
                 std::uint8_t* pixel) {
  kernels::mix_cubic(texels, part, pixel);
}
void place_row_16(const RowPath& path, int count, const std::byte* const* bricks,
                  PixelPlaces<std::uint16_t>& places) {
  kernels::place_row(path, count, bricks, places);
}
void mix_linear_16(const PixelPlaces<std::uint16_t>& places, std::size_t count,
                   const PairLines<std::uint16_t>& ahead, std::uint16_t* rgb) {
  kernels::mix_linear(places, count, ahead, rgb);
}
void mix_straight_16(const StraightRun& run, const StraightParts<std::uint16_t>& parts,
                     std::uint16_t* rgb) {
  kernels::mix_straight(run, parts, rgb);
}
void mix_cubic_16(const std::uint16_t* texels, const std::array<float, 3>& part,
                  std::uint16_t* pixel) {
  kernels::mix_cubic(texels, part, pixel);
}

}  // namespace biotomy::reconstruct::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace biotomy::reconstruct {

HWY_EXPORT(find_bricks_here);
HWY_EXPORT(place_row_8);
HWY_EXPORT(mix_linear_8);
HWY_EXPORT(mix_straight_8);
HWY_EXPORT(mix_cubic_8);
HWY_EXPORT(place_row_16);
HWY_EXPORT(mix_linear_16);
HWY_EXPORT(mix_straight_16);
HWY_EXPORT(mix_cubic_16);

std::size_t find_bricks(const RowPath& path, int count, std::int32_t* found) {
  return HWY_DYNAMIC_DISPATCH(find_bricks_here)(path, count, found);
}
template <>
void place_row(const RowPath& path, int count, const std::byte* const* bricks,
               PixelPlaces<std::uint8_t>& places) {
  HWY_DYNAMIC_DISPATCH(place_row_8)(path, count, bricks, places);
}
template <>
void mix_linear(const PixelPlaces<std::uint8_t>& places, std::size_t count,
                const PairLines<std::uint8_t>& ahead, std::uint8_t* rgb) {
  HWY_DYNAMIC_DISPATCH(mix_linear_8)(places, count, ahead, rgb);
}
template <>
void mix_straight(const StraightRun& run, const StraightParts<std::uint8_t>& parts,
                  std::uint8_t* rgb) {
  HWY_DYNAMIC_DISPATCH(mix_straight_8)(run, parts, rgb);
}
template <>
void mix_cubic(const std::uint8_t* texels, const std::array<float, 3>& part, std::uint8_t* pixel) {
  HWY_DYNAMIC_DISPATCH(mix_cubic_8)(texels, part, pixel);
}
template <>
void place_row(const RowPath& path, int count, const std::byte* const* bricks,
               PixelPlaces<std::uint16_t>& places) {
  HWY_DYNAMIC_DISPATCH(place_row_16)(path, count, bricks, places);
}
template <>
void mix_linear(const PixelPlaces<std::uint16_t>& places, std::size_t count,
                const PairLines<std::uint16_t>& ahead, std::uint16_t* rgb) {
  HWY_DYNAMIC_DISPATCH(mix_linear_16)(places, count, ahead, rgb);
}
template <>
void mix_straight(const StraightRun& run, const StraightParts<std::uint16_t>& parts,
                  std::uint16_t* rgb) {
  HWY_DYNAMIC_DISPATCH(mix_straight_16)(run, parts, rgb);
}
template <>
void mix_cubic(const std::uint16_t* texels, const std::array<float, 3>& part,
               std::uint16_t* pixel) {
  HWY_DYNAMIC_DISPATCH(mix_cubic_16)(texels, part, pixel);
}

}  // namespace biotomy::reconstruct
#endif
