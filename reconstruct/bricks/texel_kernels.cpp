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
#include "reconstruct/bricks/linear_kernel-inl.hpp"
#include "reconstruct/bricks/pack_kernel-inl.hpp"
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

void place_runs_8(const RowPath& path, std::span<const BrickRun> runs,
                  const std::byte* const* bricks, PixelPlaces<std::uint8_t>& places) {
  kernels::place_runs(path, runs, bricks, places);
}
void mix_linear_8(const PixelPlaces<std::uint8_t>& places, std::size_t count,
                  std::uint8_t* pixels) {
  kernels::mix_linear(places, count, pixels);
}
void mix_straight_8(const StraightRun& run, const StraightParts<std::uint8_t>& parts,
                    std::uint8_t* rgb) {
  kernels::mix_straight(run, parts, rgb);
}
void mix_cubic_8(const std::uint8_t* texels, const std::array<float, 3>& part,
                 std::uint8_t* pixel) {
  kernels::mix_cubic(texels, part, pixel);
}
void pack_pixels_8(const std::uint8_t* pixels, std::size_t count, std::uint8_t* rgb) {
  kernels::pack_pixels(pixels, count, rgb);
}
void place_runs_16(const RowPath& path, std::span<const BrickRun> runs,
                   const std::byte* const* bricks, PixelPlaces<std::uint16_t>& places) {
  kernels::place_runs(path, runs, bricks, places);
}
void mix_linear_16(const PixelPlaces<std::uint16_t>& places, std::size_t count,
                   std::uint16_t* pixels) {
  kernels::mix_linear(places, count, pixels);
}
void mix_straight_16(const StraightRun& run, const StraightParts<std::uint16_t>& parts,
                     std::uint16_t* rgb) {
  kernels::mix_straight(run, parts, rgb);
}
void mix_cubic_16(const std::uint16_t* texels, const std::array<float, 3>& part,
                  std::uint16_t* pixel) {
  kernels::mix_cubic(texels, part, pixel);
}
void pack_pixels_16(const std::uint16_t* pixels, std::size_t count, std::uint16_t* rgb) {
  kernels::pack_pixels(pixels, count, rgb);
}

}  // namespace biotomy::reconstruct::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace biotomy::reconstruct {

HWY_EXPORT(place_runs_8);
HWY_EXPORT(mix_linear_8);
HWY_EXPORT(mix_straight_8);
HWY_EXPORT(mix_cubic_8);
HWY_EXPORT(pack_pixels_8);
HWY_EXPORT(place_runs_16);
HWY_EXPORT(mix_linear_16);
HWY_EXPORT(mix_straight_16);
HWY_EXPORT(mix_cubic_16);
HWY_EXPORT(pack_pixels_16);

template <>
void place_runs(const RowPath& path, std::span<const BrickRun> runs, const std::byte* const* bricks,
                PixelPlaces<std::uint8_t>& places) {
  HWY_DYNAMIC_DISPATCH(place_runs_8)(path, runs, bricks, places);
}
template <>
void mix_linear(const PixelPlaces<std::uint8_t>& places, std::size_t count, std::uint8_t* pixels) {
  HWY_DYNAMIC_DISPATCH(mix_linear_8)(places, count, pixels);
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
void pack_pixels(const std::uint8_t* pixels, std::size_t count, std::uint8_t* rgb) {
  HWY_DYNAMIC_DISPATCH(pack_pixels_8)(pixels, count, rgb);
}
template <>
void place_runs(const RowPath& path, std::span<const BrickRun> runs, const std::byte* const* bricks,
                PixelPlaces<std::uint16_t>& places) {
  HWY_DYNAMIC_DISPATCH(place_runs_16)(path, runs, bricks, places);
}
template <>
void mix_linear(const PixelPlaces<std::uint16_t>& places, std::size_t count,
                std::uint16_t* pixels) {
  HWY_DYNAMIC_DISPATCH(mix_linear_16)(places, count, pixels);
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
template <>
void pack_pixels(const std::uint16_t* pixels, std::size_t count, std::uint16_t* rgb) {
  HWY_DYNAMIC_DISPATCH(pack_pixels_16)(pixels, count, rgb);
}

}  // namespace biotomy::reconstruct
#endif
