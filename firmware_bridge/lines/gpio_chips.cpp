#include "firmware_bridge/lines/gpio_chips.hpp"

#include <algorithm>
#include <cerrno>
#include <system_error>

#include <poll.h>

#include "firmware_bridge/lines/gpio_chips_version.hpp"

namespace biotomy::bridge {

namespace {

namespace fs = std::filesystem;

/// A computer whose /dev cannot be listed has no chips for us.
std::vector<fs::path> gpio_device_files() {
  std::vector<fs::path> devices;
  std::error_code error;
  fs::directory_iterator entries("/dev", error);
  for (const fs::directory_iterator end; !error && entries != end; entries.increment(error)) {
    std::error_code gone;
    const bool is_chip = entries->path().filename().string().starts_with("gpiochip") &&
                         entries->is_character_file(gone);
    // A link is a second name of a chip.
    if (is_chip && !entries->is_symlink(gone)) devices.push_back(entries->path());
  }
  // gpiochip10 comes after gpiochip9.
  std::ranges::sort(devices, {}, [](const fs::path& device) {
    return std::pair(device.native().size(), device.native());
  });
  return devices;
}

class SystemChips final : public GpioChips {
 public:
  std::vector<fs::path> devices() override { return gpio_device_files(); }
  GpioChipInfo describe(const fs::path& device) override { return describe_gpio_chip(device); }
  std::unique_ptr<GpioInput> request_input(const GpioRequest& request) override {
    return hold_gpio_input(request);
  }
  std::unique_ptr<GpioOutput> request_output(const GpioRequest& request) override {
    return hold_gpio_output(request);
  }
};

}  // namespace

std::unique_ptr<GpioChips> make_gpio_chips() {
  return std::make_unique<SystemChips>();
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
