// libgpiod 1.x (Debian 12).
#include <bitset>
#include <charconv>
#include <exception>
#include <optional>
#include <utility>

#include <gpiod.hpp>

#include "firmware_bridge/device_error.hpp"
#include "firmware_bridge/lines/gpio_line.hpp"

namespace biotomy::bridge {

namespace {

using Kind = DeviceError::Kind;

std::string name_of(const GpioLineSettings& settings) {
  return "line " + settings.line + " of GPIO chip " + settings.chip;
}

std::bitset<32> flags_of(const GpioLineSettings& settings) {
  std::bitset<32> flags;
  if (settings.active_low) flags |= gpiod::line_request::FLAG_ACTIVE_LOW;
  switch (settings.bias) {
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

/// The line by its name or, failing that, by its offset.
gpiod::line find_line(const gpiod::chip& chip, const std::string& line) {
  try {
    gpiod::line found = chip.find_line(line);
    if (found) return found;
  } catch (const std::exception&) {
    // Some 1.x releases throw when there is no such name: then it is an offset or nothing.
  }
  unsigned int offset = 0;
  const auto [end, error] = std::from_chars(line.data(), line.data() + line.size(), offset);
  if (error != std::errc() || end != line.data() + line.size() || offset >= chip.num_lines()) {
    throw std::invalid_argument("the chip has no line of that name or offset");
  }
  return chip.get_line(offset);
}

}  // namespace

struct GpioLine::Request {
  std::string name;
  gpiod::chip chip;
  gpiod::line line;

  ~Request() {
    if (line && line.is_requested()) line.release();
  }
};

GpioLine GpioLine::open(const GpioLineSettings& settings, bool is_output) {
  auto request = std::make_unique<Request>();
  request->name = name_of(settings);
  try {
    request->chip.open(settings.chip);
    request->line = find_line(request->chip, settings.line);
    const int direction =
        is_output ? gpiod::line_request::DIRECTION_OUTPUT : gpiod::line_request::DIRECTION_INPUT;
    request->line.request({"biotomyd", direction, flags_of(settings)}, 0);
  } catch (const std::exception& error) {
    throw DeviceError(Kind::configuration, request->name + ": cannot be had: " + error.what() +
                                               "; gpiodetect and gpioinfo list what there is");
  }
  return GpioLine(std::move(request));
}

bool GpioLine::is_active() {
  try {
    return request_->line.get_value() != 0;
  } catch (const std::exception& error) {
    throw DeviceError(Kind::disconnected, request_->name + ": cannot be read: " + error.what());
  }
}

void GpioLine::set_active(bool active) {
  try {
    request_->line.set_value(active ? 1 : 0);
  } catch (const std::exception& error) {
    throw DeviceError(Kind::disconnected, request_->name + ": cannot be set: " + error.what());
  }
}

GpioLine GpioLine::input(const GpioLineSettings& settings) {
  return open(settings, false);
}
GpioLine GpioLine::output(const GpioLineSettings& settings) {
  return open(settings, true);
}

GpioLine::GpioLine(std::unique_ptr<Request> request) : request_(std::move(request)) {}
GpioLine::GpioLine(GpioLine&&) noexcept = default;
GpioLine& GpioLine::operator=(GpioLine&&) noexcept = default;
GpioLine::~GpioLine() = default;

}  // namespace biotomy::bridge
