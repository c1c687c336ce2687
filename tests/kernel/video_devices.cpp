#include "tests/kernel/video_devices.hpp"

#include <chrono>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <thread>

#include "tests/integration/child_process.hpp"

namespace biotomy::tests {

namespace {

namespace fs = std::filesystem;
using std::chrono::seconds;
using std::chrono::steady_clock;

bool is_there(const std::string& name) {
  for (const auto& device : fs::directory_iterator("/sys/class/video4linux")) {
    std::ifstream file(device.path() / "name");
    std::string found;
    // The kernel cuts long names off.
    if (std::getline(file, found) && name.starts_with(found)) return true;
  }
  return false;
}

}  // namespace

void await_video_device(const std::string& name, bool there) {
  const auto deadline = steady_clock::now() + seconds(30);
  while (is_there(name) != there) {
    if (steady_clock::now() > deadline) {
      throw std::runtime_error("the kernel " + std::string(there ? "does not see" : "still sees") +
                               " the camera " + name);
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  run({"/usr/bin/env", "udevadm", "settle"}, fs::temp_directory_path());
}

}  // namespace biotomy::tests
