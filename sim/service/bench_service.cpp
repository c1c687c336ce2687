#include "sim/service/bench_service.hpp"

#include "sim/scenario/scenario.hpp"

namespace biotomy::sim {

std::optional<bridge::RigAnswer> BenchService::answer(const bridge::RigMessage& request) {
  if (const auto* input = std::get_if<bridge::SetInputMessage>(&request)) {
    rig_.set_input(input->input, input->on);
    return bridge::RigAnswer{bridge::InputSetMessage{}, {}};
  }
  if (const auto* begin = std::get_if<bridge::BeginFaultMessage>(&request)) {
    try {
      rig_.add_event(parse_event(begin->name, begin->event));
    } catch (const bridge::ConfigurationError& error) {
      throw bridge::RigRefusal(error.what());
    }
    return bridge::RigAnswer{bridge::FaultBegunMessage{}, {}};
  }
  if (const auto* end = std::get_if<bridge::EndFaultMessage>(&request)) {
    if (!rig_.end_event(end->name)) {
      throw bridge::RigRefusal("there is no fault called \"" + end->name + "\"");
    }
    return bridge::RigAnswer{bridge::FaultEndedMessage{}, {}};
  }
  throw bridge::RigRefusal("the bench does not know " + bridge::type_of(request));
}

}  // namespace biotomy::sim
