#include "acquisition/viewer/time_allowed.hpp"

#include <chrono>

namespace biotomy::acquisition {

reconstruct::StopRequested time_allowed(const ApiRequest& request) {
  using Clock = std::chrono::steady_clock;
  return [left = request.client_left, end = Clock::now() + std::chrono::seconds(kLongestAnswer)] {
    return (left && left()) || Clock::now() > end;
  };
}

}  // namespace biotomy::acquisition
