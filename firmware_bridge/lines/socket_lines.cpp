#include "firmware_bridge/lines/socket_lines.hpp"

#include "firmware_bridge/device_error.hpp"
#include "firmware_bridge/rig_device.hpp"

namespace biotomy::bridge {

namespace {

RigOutput wire_role(OutputRole role) {
  switch (role) {
    case OutputRole::lamp:
      return RigOutput::lamp;
    case OutputRole::trigger:
      return RigOutput::trigger;
    case OutputRole::tower_light:
      return RigOutput::tower_light;
  }
  throw DeviceError(DeviceError::Kind::configuration, "lines: an output without a role");
}

}  // namespace

SocketLines::SocketLines(const std::filesystem::path& socket, std::chrono::milliseconds time_out)
    : client_(socket, RigService::lines), time_out_(time_out) {}

SocketLines::~SocketLines() {
  for (const OutputRole role : std::set(switched_on_)) {
    try {
      set(role, false);
    } catch (const DeviceError&) {
      // The rig's process is gone; what its outputs do then is its own rule.
      return;
    }
  }
}

SafetyInputs SocketLines::read_inputs() {
  try {
    const RigAnswer answer = ask_device(client_, "lines", ReadInputsMessage{}, "inputs", time_out_);
    const auto& inputs = std::get<InputsMessage>(answer.message);
    return {.estop_pressed = inputs.estop_pressed, .door_open = inputs.door_open};
  } catch (const DeviceError& error) {
    return {.estop_pressed = true, .door_open = true, .failure = error.what()};
  }
}

void SocketLines::set(OutputRole role, bool on) {
  // Noted before asking: after a time-out it may be on.
  if (on) switched_on_.insert(role);
  ask_device(client_, "lines", SetOutputMessage{.role = wire_role(role), .on = on}, "output_set",
             time_out_);
  if (!on) switched_on_.erase(role);
}

}  // namespace biotomy::bridge
