// libgpiod 2.x (Debian 13).
#include <charconv>
#include <exception>
#include <filesystem>
#include <stdexcept>
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

gpiod::line::bias bias_of(LineBias bias) {
  switch (bias) {
    case LineBias::as_is:
      return gpiod::line::bias::AS_IS;
    case LineBias::disabled:
      return gpiod::line::bias::DISABLED;
    case LineBias::pull_up:
      return gpiod::line::bias::PULL_UP;
    case LineBias::pull_down:
      return gpiod::line::bias::PULL_DOWN;
  }
  return gpiod::line::bias::AS_IS;
}

/// Version 2 opens chips by path alone; names and labels are looked up here as version 1 did.
gpiod::chip open_chip(const std::string& chip) {
  for (const std::filesystem::path& path :
       {std::filesystem::path(chip), std::filesystem::path("/dev") / chip}) {
    if (gpiod::is_gpiochip_device(path)) return gpiod::chip(path);
  }
  for (const auto& entry : std::filesystem::directory_iterator("/dev")) {
    if (!entry.path().filename().string().starts_with("gpiochip") ||
        !gpiod::is_gpiochip_device(entry.path())) {
      continue;
    }
    gpiod::chip candidate(entry.path());
    if (candidate.get_info().label() == chip) return candidate;
  }
  throw std::invalid_argument("there is no chip of that path, name or label");
}

/// The line by its name or, failing that, by its offset.
gpiod::line::offset find_line(const gpiod::chip& chip, const std::string& line) {
  const int named = chip.get_line_offset_from_name(line);
  if (named >= 0) return static_cast<unsigned int>(named);
  unsigned int offset = 0;
  const auto [end, error] = std::from_chars(line.data(), line.data() + line.size(), offset);
  if (error != std::errc() || end != line.data() + line.size() ||
      offset >= chip.get_info().num_lines()) {
    throw std::invalid_argument("the chip has no line of that name or offset");
  }
  return offset;
}

}  // namespace

struct GpioLine::Request {
  std::string name;
  gpiod::line::offset offset;
  gpiod::line_request request;
};

GpioLine GpioLine::open(const GpioLineSettings& settings, bool is_output) {
  const std::string name = name_of(settings);
  try {
    gpiod::chip chip = open_chip(settings.chip);
    const gpiod::line::offset offset = find_line(chip, settings.line);
    gpiod::line_settings line;
    line.set_direction(is_output ? gpiod::line::direction::OUTPUT : gpiod::line::direction::INPUT)
        .set_active_low(settings.active_low)
        .set_bias(bias_of(settings.bias));
    if (is_output) line.set_output_value(gpiod::line::value::INACTIVE);
    return GpioLine(std::make_unique<Request>(Request{name, offset,
                                                      chip.prepare_request()
                                                          .set_consumer("biotomyd")
                                                          .add_line_settings(offset, line)
                                                          .do_request()}));
  } catch (const std::exception& error) {
    throw DeviceError(Kind::configuration, name + ": cannot be had: " + error.what() +
                                               "; gpiodetect and gpioinfo list what there is");
  }
}

bool GpioLine::is_active() {
  try {
    return request_->request.get_value(request_->offset) == gpiod::line::value::ACTIVE;
  } catch (const std::exception& error) {
    throw DeviceError(Kind::disconnected, request_->name + ": cannot be read: " + error.what());
  }
}

void GpioLine::set_active(bool active) {
  try {
    request_->request.set_value(request_->offset,
                                active ? gpiod::line::value::ACTIVE : gpiod::line::value::INACTIVE);
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
