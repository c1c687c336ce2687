#pragma once

#include <cstdint>
#include <functional>
#include <iostream>
#include <string>

#include <gtest/gtest.h>

#include "reconstruct/bricks/vector_targets.hpp"

namespace biotomy::reconstruct {

/// Lets the kernels run on vectors of one width, whatever this processor's widest is.
class VectorWidth {
 public:
  explicit VectorWidth(std::int64_t target) { hwy::SetSupportedTargetsForTest(target); }
  ~VectorWidth() { hwy::SetSupportedTargetsForTest(0); }
  VectorWidth(const VectorWidth&) = delete;
  VectorWidth& operator=(const VectorWidth&) = delete;
};

/// Each width that was compiled and that this processor has; the report says which they were.
inline void for_each_vector_width(const std::function<void()>& check) {
  std::string names;
  for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
    SCOPED_TRACE(hwy::TargetName(target));
    const VectorWidth width(target);
    check();
    names += std::string(names.empty() ? "" : " ") + hwy::TargetName(target);
  }
  EXPECT_FALSE(names.empty());
  std::cout << "on " << names << '\n';
}

}  // namespace biotomy::reconstruct
