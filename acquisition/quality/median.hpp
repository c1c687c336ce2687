#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace biotomy::acquisition {

/// Of at least one value; of an even number of them the mean of the two in the middle.
template <typename Value>
Value median(std::vector<Value> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  if (values.size() % 2 == 1) return *middle;
  return (*middle + *std::max_element(values.begin(), middle)) / Value{2};
}

}  // namespace biotomy::acquisition
