#pragma once

#include <cstddef>

#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/task_group.h>

namespace biotomy::reconstruct {

/// Calls `body(i)` for each i below `count`, in parallel, and returns when all are done, or throws
/// what one of them threw. A plain tbb::parallel_for within another parallel work returns with a
/// part undone, and without a word, when that work is cancelled because some other task of it
/// threw: what it should have filled would then be taken for whole.
template <typename Body>
void whole_loop(std::size_t count, const Body& body) {
  tbb::task_group_context context(tbb::task_group_context::isolated);
  tbb::parallel_for(std::size_t{0}, count, body, context);
}

}  // namespace biotomy::reconstruct
