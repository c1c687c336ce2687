#pragma once

#include <chrono>
#include <string>

namespace biotomy::acquisition {

/// ISO 8601 with milliseconds: 2026-11-22T03:04:05.678Z.
std::string utc_text(std::chrono::system_clock::time_point time);

}  // namespace biotomy::acquisition
