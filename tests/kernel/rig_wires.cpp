#include "tests/kernel/rig_wires.hpp"

#include <chrono>
#include <exception>
#include <iostream>
#include <variant>

#include "firmware_bridge/wire/rig_client.hpp"

namespace biotomy::tests {

namespace {

constexpr std::chrono::seconds kPatience(20);
constexpr std::chrono::milliseconds kInterval(5);

}  // namespace

RigWires::RigWires(GpioSimChip& chip, std::filesystem::path rig)
    : chip_(chip),
      rig_(std::move(rig)),
      thread_([this](const std::stop_token& stop) { carry(stop); }) {}

void RigWires::carry(const std::stop_token& stop) {
  bridge::RigClient rig(rig_, bridge::RigService::lines);
  bool is_lit = false;
  bool is_lamp_told = false;
  for (; !stop.stop_requested(); std::this_thread::sleep_for(kInterval)) {
    bridge::InputsMessage inputs;  // of danger
    try {
      const bool lit = chip_.is_high(lamp);
      if (!is_lamp_told || lit != is_lit) {
        rig.ask(bridge::SetOutputMessage{.role = bridge::RigOutput::lamp, .on = lit}, kPatience);
        is_lit = lit;
        is_lamp_told = true;
      }
      const auto answer = rig.ask(bridge::ReadInputsMessage{}, kPatience);
      inputs = std::get<bridge::InputsMessage>(answer.message);
    } catch (const std::exception& error) {
      std::cerr << "the wires: " << error.what() << std::endl;
      is_lamp_told = false;
    }
    set_contacts(inputs.estop_pressed, inputs.door_open);
  }
}

void RigWires::set_contacts(bool estop_open, bool door_open) {
  const std::unique_lock hold(contacts_, std::try_to_lock);
  if (!hold.owns_lock()) return;
  if (!is_told_ || estop_open != estop_open_) chip_.pull(estop, estop_open);
  if (!is_told_ || door_open != door_open_) chip_.pull(door, door_open);
  estop_open_ = estop_open;
  door_open_ = door_open;
  is_told_ = true;
}

}  // namespace biotomy::tests
