#pragma once

#include <cstddef>
#include <memory>

namespace biotomy::reconstruct {

/// Memory for many blocks of one size. Blocks are cut from slabs of 2 MiB and more that the kernel
/// may map as huge pages: a section walks over hundreds of blocks, and with small pages most of its
/// time would go into page faults and address translation. Freed blocks are used again; slabs are
/// given back when the pool and its last block are gone. Safe for many threads.
class BlockPool {
 public:
  /// A block is aligned to 64 bytes; `slack` bytes behind its end may be read.
  BlockPool(std::size_t block_bytes, std::size_t slack);

  std::shared_ptr<std::byte> allocate();

  std::size_t block_bytes() const;

 private:
  struct State;
  std::shared_ptr<State> state_;
};

}  // namespace biotomy::reconstruct
