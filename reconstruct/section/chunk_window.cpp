#include "reconstruct/section/chunk_window.hpp"

#include <utility>

#include "reconstruct/errors.hpp"

namespace biotomy::reconstruct {
namespace {

constexpr std::size_t kColours = 3;

}  // namespace

ChunkWindow::ChunkWindow(ChunkSource& source, const VoxelBox& box)
    : source_(source),
      shape_{source.chunk_shape()[2], source.chunk_shape()[1], source.chunk_shape()[0]},
      first_{},
      count_{},
      chunk_bytes_(kColours * static_cast<std::size_t>(source.bits() / 8)) {
  std::size_t slots = 1;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    first_[axis] = box.first[axis] / shape_[axis];
    count_[axis] = box.last[axis] / shape_[axis] - first_[axis] + 1;
    slots *= static_cast<std::size_t>(count_[axis]);
    chunk_bytes_ *= static_cast<std::size_t>(shape_[axis]);
  }
  voxels_.resize(slots, nullptr);
}

const std::byte* ChunkWindow::fetch(const std::array<int, 3>& chunk, std::size_t slot) {
  const auto start = std::chrono::steady_clock::now();
  const ChunkIndex index{chunk[2], chunk[1], chunk[0]};
  std::shared_ptr<const ChunkVoxels> fetched = source_.chunk(index);
  if (fetched == nullptr) {
    if (fill_ == nullptr) {
      fill_ = std::make_unique<ChunkVoxels>(chunk_bytes_, std::byte{0});
    }
    voxels_[slot] = fill_->data();
  } else if (fetched->size() != chunk_bytes_) {
    throw SampleError("a chunk of the volume has the wrong size: rebuild the volume");
  } else {
    voxels_[slot] = fetched->data();
    held_.push_back(std::move(fetched));
  }
  touched_.push_back(index);
  time_fetching_ += std::chrono::steady_clock::now() - start;
  return voxels_[slot];
}

}  // namespace biotomy::reconstruct
