#include "firmware_bridge/lines/gpiod_lines.hpp"

#include <utility>

#include "firmware_bridge/device_error.hpp"
#include "firmware_bridge/lines/gpio_line_request.hpp"

namespace biotomy::bridge {

namespace {

/// As the line's table in the configuration is called.
std::string table_of(const char* role) {
  return std::string("lines.") + role;
}

}  // namespace

GpiodLines::GpiodLines(const GpiodLinesSettings& settings, std::unique_ptr<GpioChips> chips,
                       Clock clock)
    : chips_(std::move(chips)),
      clock_(std::move(clock)),
      debounce_(settings.debounce),
      estop_(open_input("estop", settings.estop)),
      door_(open_input("door", settings.door)),
      lamp_(open_output(OutputRole::lamp, settings.lamp)),
      trigger_(open_output(OutputRole::trigger, settings.trigger)),
      tower_light_(open_output(OutputRole::tower_light, settings.tower_light)) {}

GpiodLines::~GpiodLines() {
  for_each_output([](Output& output) {
    if (output.is_lost()) return;
    try {
      output.use([](GpioOutput& line) { line.set_active(false); });
    } catch (const DeviceError&) {
      // The chip is gone: there is nothing left to switch, and nobody to tell in a destructor.
    }
  });
}

SafetyInputs GpiodLines::read_inputs() {
  SafetyInputs inputs;
  inputs.estop_pressed = is_unsafe(estop_, inputs.failure);
  inputs.door_open = is_unsafe(door_, inputs.failure);
  // What was on when its chip went away must not stay on when it comes back.
  for_each_output([](Output& output) {
    try {
      output.regain();
    } catch (const DeviceError&) {
      // `set` tells whoever wants to switch it.
    }
  });
  return inputs;
}

void GpiodLines::set(OutputRole role, bool on) {
  output(role).use([on](GpioOutput& line) { line.set_active(on); });
}

GpiodLines::Input GpiodLines::open_input(const char* role, const GpioLineSettings& settings) {
  return {
      .line = {table_of(role),
               [request = GpioLineRequest(*chips_, settings)]() mutable { return request.input(); },
               clock_},
      .debounce = InputDebounce(debounce_)};
}

GpiodLines::Output GpiodLines::open_output(OutputRole role, const GpioLineSettings& settings) {
  return {table_of(to_string(role)),
          [request = GpioLineRequest(*chips_, settings)]() mutable { return request.output(); },
          clock_};
}

std::optional<GpiodLines::Output> GpiodLines::open_output(
    OutputRole role, const std::optional<GpioLineSettings>& settings) {
  if (!settings) return std::nullopt;
  return open_output(role, *settings);
}

bool GpiodLines::is_unsafe(Input& input, std::string& failure) {
  try {
    // The level is read after the edges were taken: one that comes in between is the next call's.
    const auto [had_edges, is_active] = input.line.use([](GpioInput& line) {
      const bool edges = line.take_edges();
      return std::pair(edges, line.is_active());
    });
    return input.debounce.look(had_edges, is_active, clock_());
  } catch (const DeviceError& error) {
    input.debounce.doubt(clock_());
    failure += (failure.empty() ? "" : "; ") + std::string(error.what());
    return true;
  }
}

GpiodLines::Output& GpiodLines::output(OutputRole role) {
  if (role == OutputRole::lamp) return lamp_;
  std::optional<Output>& line = role == OutputRole::trigger ? trigger_ : tower_light_;
  if (!line) {
    throw DeviceError(DeviceError::Kind::configuration, std::string("lines: no line is set for ") +
                                                            to_string(role) +
                                                            "; name one in the configuration");
  }
  return *line;
}

template <class Act>
void GpiodLines::for_each_output(Act act) {
  act(lamp_);
  if (trigger_) act(*trigger_);
  if (tower_light_) act(*tower_light_);
}

}  // namespace biotomy::bridge
