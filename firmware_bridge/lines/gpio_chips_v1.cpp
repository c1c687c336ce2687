// libgpiod 1.x (Debian 12).
#include <bitset>
#include <utility>

#include <gpiod.hpp>

#include "firmware_bridge/lines/gpio_chips_version.hpp"

namespace biotomy::bridge {

namespace {

std::bitset<32> flags_of(const GpioRequest& request) {
  std::bitset<32> flags;
  if (request.active_low) flags |= gpiod::line_request::FLAG_ACTIVE_LOW;
  switch (request.bias) {
    case LineBias::as_is:
      break;
    case LineBias::disabled:
      flags |= gpiod::line_request::FLAG_BIAS_DISABLE;
      break;
    case LineBias::pull_up:
      flags |= gpiod::line_request::FLAG_BIAS_PULL_UP;
      break;
    case LineBias::pull_down:
      flags |= gpiod::line_request::FLAG_BIAS_PULL_DOWN;
      break;
  }
  return flags;
}

gpiod::chip open_chip(const std::filesystem::path& device) {
  return {device.string(), gpiod::chip::OPEN_BY_PATH};
}

/// A requested line with the chip it belongs to; it is released with the object.
class HeldLine {
 public:
  HeldLine(const GpioRequest& request, int type)
      : chip_(open_chip(request.device)), line_(chip_.get_line(request.offset)) {
    line_.request({kGpioConsumer, type, flags_of(request)}, 0);
  }
  ~HeldLine() { line_.release(); }
  HeldLine(const HeldLine&) = delete;
  HeldLine& operator=(const HeldLine&) = delete;

  const gpiod::line& line() const { return line_; }

 private:
  gpiod::chip chip_;
  gpiod::line line_;
};

class Input final : public GpioInput {
 public:
  explicit Input(const GpioRequest& request)
      : held_(request, request.edges ? gpiod::line_request::EVENT_BOTH_EDGES
                                     : gpiod::line_request::DIRECTION_INPUT),
        has_edges_(request.edges) {}

  bool take_edges() override {
    if (!has_edges_ || !is_readable_now(held_.line().event_get_fd())) return false;
    // One read empties the queue: it takes 16 events, and the kernel keeps no more.
    held_.line().event_read_multiple();
    return true;
  }

  bool is_active() override { return held_.line().get_value() != 0; }

 private:
  HeldLine held_;
  bool has_edges_;
};

class Output final : public GpioOutput {
 public:
  explicit Output(const GpioRequest& request)
      : held_(request, gpiod::line_request::DIRECTION_OUTPUT) {}

  void set_active(bool active) override { held_.line().set_value(active ? 1 : 0); }

 private:
  HeldLine held_;
};

}  // namespace

GpioChipInfo describe_gpio_chip(const std::filesystem::path& device) {
  const gpiod::chip chip = open_chip(device);
  GpioChipInfo info{.device = device, .name = chip.name(), .label = chip.label(), .lines = {}};
  for (unsigned int offset = 0; offset < chip.num_lines(); ++offset) {
    const gpiod::line line = chip.get_line(offset);
    info.lines.push_back({.name = line.name(),
                          .is_output = line.direction() == gpiod::line::DIRECTION_OUTPUT,
                          .is_used = line.is_used(),
                          .consumer = line.consumer()});
  }
  return info;
}

std::unique_ptr<GpioInput> hold_gpio_input(const GpioRequest& request) {
  return std::make_unique<Input>(request);
}

std::unique_ptr<GpioOutput> hold_gpio_output(const GpioRequest& request) {
  return std::make_unique<Output>(request);
}

}  // namespace biotomy::bridge
