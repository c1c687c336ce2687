#include "reconstruct/export/voxel_region.hpp"

#include <charconv>
#include <string_view>

#include "reconstruct/errors.hpp"

namespace biotomy::reconstruct {
namespace {

[[noreturn]] void refuse(const std::string& text) {
  throw InvalidRequest("region '" + text +
                       "': give x0:x1,y0:y1,z0:z1, voxels from 0, the second number not included");
}

std::int64_t number_or(std::string_view digits, std::int64_t border, const std::string& text) {
  if (digits.empty()) {
    return border;
  }
  std::int64_t number = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), number);
  if (error != std::errc() || end != digits.data() + digits.size() || number < 0) {
    refuse(text);
  }
  return number;
}

VoxelRange parse_range(std::string_view part, const VoxelRange& whole, char axis,
                       const std::string& text) {
  const std::size_t colon = part.find(':');
  if (colon == std::string_view::npos) {
    refuse(text);
  }
  const VoxelRange range{number_or(part.substr(0, colon), whole.first, text),
                         number_or(part.substr(colon + 1), whole.end, text)};
  if (range.first >= range.end) {
    refuse(text);
  }
  if (range.end > whole.end) {
    throw SampleError("region '" + text + "': there are voxels from 0 to " +
                      std::to_string(whole.end) + " along " + axis);
  }
  return range;
}

VoxelRange range_of_level(const VoxelRange& range, std::int64_t step) {
  return {range.first / step, (range.end + step - 1) / step};
}

}  // namespace

VoxelRegion parse_region(const std::string& text, const VoxelRegion& whole) {
  const std::size_t first = text.find(',');
  const std::size_t second = first == std::string::npos ? first : text.find(',', first + 1);
  if (second == std::string::npos || text.find(',', second + 1) != std::string::npos) {
    refuse(text);
  }
  const std::string_view view(text);
  return {parse_range(view.substr(0, first), whole.x, 'x', text),
          parse_range(view.substr(first + 1, second - first - 1), whole.y, 'y', text),
          parse_range(view.substr(second + 1), whole.z, 'z', text)};
}

VoxelRegion whole_level(const Volume& volume, int level, std::int64_t layers) {
  const PyramidLevel& place = volume.level(level);
  const std::int64_t depth = (layers + place.factor.z - 1) / place.factor.z;
  return {{0, place.size.x}, {0, place.size.y}, {0, depth}};
}

VoxelRegion region_of_level(const VoxelRegion& region, const PyramidLevel& finer,
                            const PyramidLevel& coarser) {
  return {range_of_level(region.x, coarser.factor.x / finer.factor.x),
          range_of_level(region.y, coarser.factor.y / finer.factor.y),
          range_of_level(region.z, coarser.factor.z / finer.factor.z)};
}

}  // namespace biotomy::reconstruct
