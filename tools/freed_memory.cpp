#include "tools/freed_memory.hpp"

#include <limits>

#include <malloc.h>

namespace biotomy::tools {

void keep_freed_memory() {
  constexpr int kGrowBy = 64 << 20;
  ::mallopt(M_MMAP_MAX, 0);   // blocks of their own go back when they are freed
  ::mallopt(M_ARENA_MAX, 1);  // those of threads hold no large blocks
  ::mallopt(M_TRIM_THRESHOLD, std::numeric_limits<int>::max());
  ::mallopt(M_TOP_PAD, kGrowBy);
}

}  // namespace biotomy::tools
