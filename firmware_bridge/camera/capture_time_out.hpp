#pragma once

#include <chrono>

namespace biotomy::bridge {

// How long a capture may last, and be without any frame, by how long a frame is exposed.

/// Sessions that one capture may use up: a camera that stalls is started anew.
inline constexpr int kSessionsOfACapture = 3;

/// The least time-out with which a camera in order gives a frame that can be believed.
std::chrono::milliseconds least_time_out(std::chrono::microseconds exposure);

/// Without a frame for so long a camera stalls: the time-out's share for each session, and several
/// exposures in any case.
std::chrono::milliseconds longest_silence(std::chrono::milliseconds time_out,
                                          std::chrono::microseconds exposure);

}  // namespace biotomy::bridge
