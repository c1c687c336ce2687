#pragma once

#include <string>

namespace biotomy::tests {

/// Waits until the kernel has a camera of this name, or has it no more, and udevd, from which
/// libcamera hears of it, is done with that. Throws std::runtime_error when time is up.
void await_video_device(const std::string& name, bool there);

}  // namespace biotomy::tests
