#pragma once

#include <atomic>
#include <cstddef>
#include <memory>
#include <mutex>
#include <utility>

#include "reconstruct/bricks/brick_cells.hpp"

namespace biotomy::reconstruct {

/// A brick of which some cells may not be laid out yet. Others may read those that are while more
/// are added. Safe for many threads.
class PartialBrick {
 public:
  explicit PartialBrick(std::shared_ptr<std::byte> texels) : texels_(std::move(texels)) {}

  const std::byte* texels() const { return texels_.get(); }

  bool holds(CellSet cells) const {
    return (cells & ~laid_out_.load(std::memory_order_acquire)) == 0;
  }

  /// `lay_out(missing, texels)` writes those of `cells` that are not laid out yet.
  template <typename LayOut>
  void add(CellSet cells, LayOut&& lay_out) {
    const std::lock_guard lock(mutex_);
    const CellSet before = laid_out_.load(std::memory_order_relaxed);
    if (const CellSet missing = cells & ~before; missing != 0) {
      lay_out(missing, texels_.get());
      laid_out_.store(before | missing, std::memory_order_release);
    }
  }

 private:
  std::shared_ptr<std::byte> texels_;
  std::mutex mutex_;
  std::atomic<CellSet> laid_out_{0};
};

}  // namespace biotomy::reconstruct
