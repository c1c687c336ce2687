#include "firmware_bridge/lines/gpio_chips.hpp"

#include <algorithm>
#include <cerrno>
#include <system_error>

#include <poll.h>

namespace biotomy::bridge {

std::vector<std::filesystem::path> gpio_device_files() {
  std::vector<std::filesystem::path> devices;
  std::error_code ignored;  // a computer whose /dev cannot be listed has no chips for us
  for (const auto& entry : std::filesystem::directory_iterator("/dev", ignored)) {
    if (!entry.path().filename().string().starts_with("gpiochip")) continue;
    // A link is a second name of a chip, or dangles.
    if (entry.is_character_file(ignored) && !entry.is_symlink(ignored)) {
      devices.push_back(entry.path());
    }
  }
  // gpiochip10 comes after gpiochip9.
  std::ranges::sort(devices, {}, [](const std::filesystem::path& device) {
    return std::pair(device.native().size(), device.native());
  });
  return devices;
}

bool is_readable_now(int descriptor) {
  pollfd waited{.fd = descriptor, .events = POLLIN, .revents = 0};
  int ready = -1;
  do {
    ready = ::poll(&waited, 1, 0);
  } while (ready < 0 && errno == EINTR);
  if (ready < 0) throw std::system_error(errno, std::generic_category(), "poll");
  return ready > 0;
}

}  // namespace biotomy::bridge
