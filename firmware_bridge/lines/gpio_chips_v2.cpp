// libgpiod 2.x (Debian 13).
#include <cerrno>
#include <stdexcept>
#include <system_error>
#include <utility>

#include <gpiod.hpp>

#include "firmware_bridge/lines/gpio_chips_version.hpp"

namespace biotomy::bridge {

namespace {

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

gpiod::line_settings settings_of(const GpioRequest& request, gpiod::line::direction direction) {
  gpiod::line_settings settings;
  settings.set_direction(direction)
      .set_active_low(request.active_low)
      .set_bias(bias_of(request.bias));
  return settings;
}

/// The library has an exception of its own for EINVAL, and std::system_error for other errors.
template <class Act>
auto with_system_errors(Act act) {
  try {
    return act();
  } catch (const std::invalid_argument& error) {
    throw std::system_error(EINVAL, std::system_category(), error.what());
  }
}

gpiod::line_request ask_for(const GpioRequest& request, const gpiod::line_settings& settings) {
  return with_system_errors([&] {
    return gpiod::chip(request.device)
        .prepare_request()
        .set_consumer(kGpioConsumer)
        .add_line_settings(gpiod::line::offset(request.offset), settings)
        .do_request();
  });
}

class Input final : public GpioInput {
 public:
  explicit Input(const GpioRequest& request)
      : offset_(request.offset),
        has_edges_(request.edges),
        request_(
            ask_for(request, settings_of(request, gpiod::line::direction::INPUT)
                                 .set_edge_detection(request.edges ? gpiod::line::edge::BOTH
                                                                   : gpiod::line::edge::NONE))) {}

  bool take_edges() override {
    if (!has_edges_ || !is_readable_now(request_.fd())) return false;
    // One read empties the queue: the buffer takes 64 events, and the kernel keeps 16 a line.
    request_.read_edge_events(events_);
    return true;
  }

  bool is_active() override { return request_.get_value(offset_) == gpiod::line::value::ACTIVE; }

 private:
  gpiod::line::offset offset_;
  bool has_edges_;
  gpiod::line_request request_;
  gpiod::edge_event_buffer events_;
};

class Output final : public GpioOutput {
 public:
  explicit Output(const GpioRequest& request)
      : offset_(request.offset),
        request_(ask_for(request, settings_of(request, gpiod::line::direction::OUTPUT)
                                      .set_output_value(gpiod::line::value::INACTIVE))) {}

  void set_active(bool active) override {
    request_.set_value(offset_, active ? gpiod::line::value::ACTIVE : gpiod::line::value::INACTIVE);
  }

 private:
  gpiod::line::offset offset_;
  gpiod::line_request request_;
};

}  // namespace

GpioChipInfo describe_gpio_chip(const std::filesystem::path& device) {
  return with_system_errors([&] {
    const gpiod::chip chip(device);
    const gpiod::chip_info about = chip.get_info();
    GpioChipInfo info{.device = device, .name = about.name(), .label = about.label(), .lines = {}};
    for (std::size_t offset = 0; offset < about.num_lines(); ++offset) {
      const gpiod::line_info line =
          chip.get_line_info(gpiod::line::offset(static_cast<unsigned int>(offset)));
      info.lines.push_back({.name = line.name(),
                            .is_output = line.direction() == gpiod::line::direction::OUTPUT,
                            .is_used = line.used(),
                            .consumer = line.consumer()});
    }
    return info;
  });
}

std::unique_ptr<GpioInput> hold_gpio_input(const GpioRequest& request) {
  return std::make_unique<Input>(request);
}

std::unique_ptr<GpioOutput> hold_gpio_output(const GpioRequest& request) {
  return std::make_unique<Output>(request);
}

}  // namespace biotomy::bridge
