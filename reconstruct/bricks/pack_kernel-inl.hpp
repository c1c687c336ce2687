// Included once for each vector width: see texel_kernels.cpp.
#if defined(BIOTOMY_PACK_KERNEL_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef BIOTOMY_PACK_KERNEL_INL
#undef BIOTOMY_PACK_KERNEL_INL
#else
#define BIOTOMY_PACK_KERNEL_INL
#endif

#include <cstddef>

#include <hwy/highway.h>

#include "reconstruct/bricks/texel_kernels_scalar.hpp"

HWY_BEFORE_NAMESPACE();
namespace biotomy::reconstruct::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

template <typename Level>
void pack_pixels(const Level* pixels, std::size_t count, Level* rgb) {
  const hn::ScalableTag<Level> d;
  std::size_t i = 0;
  for (; i + hn::Lanes(d) <= count; i += hn::Lanes(d)) {
    hn::Vec<decltype(d)> red;
    hn::Vec<decltype(d)> green;
    hn::Vec<decltype(d)> blue;
    hn::Vec<decltype(d)> unused;
    hn::LoadInterleaved4(d, pixels + 4 * i, red, green, blue, unused);
    hn::StoreInterleaved3(red, green, blue, d, rgb + 3 * i);
  }
  scalar::pack_pixels(pixels + 4 * i, count - i, rgb + 3 * i);
}

}  // namespace biotomy::reconstruct::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
