#include "sim/service/line_service.hpp"

namespace biotomy::sim {

std::optional<bridge::WelcomeMessage> LineService::welcome() {
  return rig_.lines_silent() ? std::nullopt : std::optional(bridge::WelcomeMessage{});
}

std::optional<bridge::RigAnswer> LineService::answer(const bridge::RigMessage& request) {
  if (rig_.lines_silent()) {
    return std::nullopt;
  }
  if (std::holds_alternative<bridge::ReadInputsMessage>(request)) {
    const SafetyInputs inputs = rig_.inputs();
    return bridge::RigAnswer{bridge::InputsMessage{inputs.estop_pressed, inputs.door_open}, {}};
  }
  if (const auto* output = std::get_if<bridge::SetOutputMessage>(&request)) {
    rig_.set_output(output->role, output->on);
    return bridge::RigAnswer{bridge::OutputSetMessage{}, {}};
  }
  throw bridge::RigRefusal("the lines do not know " + bridge::type_of(request));
}

}  // namespace biotomy::sim
