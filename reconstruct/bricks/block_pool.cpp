#include "reconstruct/bricks/block_pool.hpp"

#include <algorithm>
#include <mutex>
#include <new>
#include <vector>

#include <sys/mman.h>

namespace biotomy::reconstruct {
namespace {

constexpr std::size_t kAlignment = 64;
constexpr std::size_t kHugePage = std::size_t{2} << 20;

std::size_t round_up(std::size_t bytes, std::size_t unit) {
  return (bytes + unit - 1) / unit * unit;
}

}  // namespace

struct BlockPool::State {
  std::size_t block_bytes = 0;
  std::size_t stride = 0;
  std::size_t slab_bytes = 0;
  std::mutex mutex;
  std::vector<std::byte*> slabs;
  std::vector<std::byte*> free;

  ~State() {
    for (std::byte* slab : slabs) {
      ::operator delete (slab, std::align_val_t{kHugePage});
    }
  }

  void add_slab() {
    auto* slab = static_cast<std::byte*>(::operator new (slab_bytes, std::align_val_t{kHugePage}));
    slabs.push_back(slab);
    ::madvise(slab, slab_bytes, MADV_HUGEPAGE);  // a hint: without huge pages it is only slower
    free.reserve(slabs.size() * (slab_bytes / stride));
    for (std::size_t place = 0; place + stride <= slab_bytes; place += stride) {
      free.push_back(slab + place);
    }
    std::reverse(free.begin(), free.end());
  }
};

BlockPool::BlockPool(std::size_t block_bytes, std::size_t slack)
    : state_(std::make_shared<State>()) {
  state_->block_bytes = block_bytes;
  state_->stride = round_up(block_bytes + slack, kAlignment);
  state_->slab_bytes = round_up(state_->stride, kHugePage);
}

std::size_t BlockPool::block_bytes() const {
  return state_->block_bytes;
}

std::shared_ptr<std::byte> BlockPool::allocate() {
  std::byte* block = nullptr;
  {
    const std::lock_guard lock(state_->mutex);
    if (state_->free.empty()) {
      state_->add_slab();
    }
    block = state_->free.back();
    state_->free.pop_back();
  }
  return {block, [state = state_](std::byte* returned) {
            const std::lock_guard lock(state->mutex);
            state->free.push_back(returned);  // has room: reserved with its slab
          }};
}

}  // namespace biotomy::reconstruct
