#include "sim/service/line_service.hpp"

namespace biotomy::sim {

bridge::RigAnswer LineService::answer(const bridge::RigMessage& request) {
  if (std::holds_alternative<bridge::ReadInputsMessage>(request)) {
    const SafetyInputs inputs = rig_.inputs();
    return {bridge::InputsMessage{inputs.estop_pressed, inputs.door_open}, {}};
  }
  if (const auto* output = std::get_if<bridge::SetOutputMessage>(&request)) {
    rig_.set_output(output->role, output->on);
    return {bridge::OutputSetMessage{}, {}};
  }
  throw bridge::RigRefusal("the lines do not know " + bridge::type_of(request));
}

bridge::RigAnswer BenchService::answer(const bridge::RigMessage& request) {
  if (const auto* input = std::get_if<bridge::SetInputMessage>(&request)) {
    rig_.set_input(input->input, input->on);
    return {bridge::InputSetMessage{}, {}};
  }
  throw bridge::RigRefusal("the bench does not know " + bridge::type_of(request));
}

}  // namespace biotomy::sim
