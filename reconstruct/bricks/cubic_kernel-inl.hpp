// Included once for each vector width: see texel_kernels.cpp.
#if defined(BIOTOMY_CUBIC_KERNEL_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef BIOTOMY_CUBIC_KERNEL_INL
#undef BIOTOMY_CUBIC_KERNEL_INL
#else
#define BIOTOMY_CUBIC_KERNEL_INL
#endif

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>

#include <hwy/highway.h>

#include "reconstruct/bricks/texel_kernels_scalar.hpp"

HWY_BEFORE_NAMESPACE();
namespace biotomy::reconstruct::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

template <typename Level>
void mix_cubic(const Level* texels, const std::array<float, 3>& part, Level* pixel) {
  constexpr auto kMost = static_cast<float>(std::numeric_limits<Level>::max());
  const hn::FixedTag<float, 4> d;
  const hn::FixedTag<std::int32_t, 4> whole;
  const hn::FixedTag<Level, 4> levels;
  const std::array<float, 4> along_x = scalar::catmull_rom(part[0]);
  const std::array<float, 4> along_y = scalar::catmull_rom(part[1]);
  const std::array<float, 4> along_z = scalar::catmull_rom(part[2]);
  auto sum = hn::Set(d, 0.5F);
  for (const float part_z : along_z) {
    auto of_layer = hn::Zero(d);
    for (const float part_y : along_y) {
      auto of_row = hn::Zero(d);
      for (const float part_x : along_x) {
        const auto texel = hn::ConvertTo(d, hn::PromoteTo(whole, hn::LoadU(levels, texels)));
        of_row = hn::MulAdd(texel, hn::Set(d, part_x), of_row);
        texels += 4;
      }
      of_layer = hn::MulAdd(of_row, hn::Set(d, part_y), of_layer);
    }
    sum = hn::MulAdd(of_layer, hn::Set(d, part_z), sum);
  }
  const auto clamped = hn::Min(hn::Max(sum, hn::Zero(d)), hn::Set(d, kMost));
  hn::StoreU(hn::DemoteTo(levels, hn::ConvertTo(whole, clamped)), levels, pixel);
}

}  // namespace biotomy::reconstruct::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
