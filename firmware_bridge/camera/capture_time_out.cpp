#include "firmware_bridge/camera/capture_time_out.hpp"

#include <algorithm>

namespace biotomy::bridge {
namespace {

using std::chrono::ceil;
using std::chrono::milliseconds;

/// A stream that starts has its first frame later than one that runs.
constexpr int kSilentExposures = 4;

/// FrameGate refuses up to ten frames of a stream that has just been started with a lens.
constexpr int kExposuresOfACapture = kSessionsOfACapture * kSilentExposures;

}  // namespace

milliseconds least_time_out(std::chrono::microseconds exposure) {
  return ceil<milliseconds>(kExposuresOfACapture * exposure);
}

milliseconds longest_silence(milliseconds time_out, std::chrono::microseconds exposure) {
  return std::max(time_out / kSessionsOfACapture, ceil<milliseconds>(kSilentExposures * exposure));
}

}  // namespace biotomy::bridge
