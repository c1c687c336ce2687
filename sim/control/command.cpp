#include "sim/control/command.hpp"

namespace biotomy::sim {

const char* to_string(Fault fault) {
  switch (fault) {
    case Fault::none:
      return "none";
    case Fault::estop:
      return "e-stop";
    case Fault::door:
      return "door";
    case Fault::watchdog:
      return "watchdog";
    case Fault::limit:
      return "limit";
    case Fault::drive:
      return "drive";
    case Fault::spindle_overload:
      return "spindle overload";
  }
  return "unknown";
}

const char* to_string(CommandResult result) {
  switch (result) {
    case CommandResult::none:
      return "none";
    case CommandResult::done:
      return "done";
    case CommandResult::refused:
      return "refused";
    case CommandResult::aborted:
      return "aborted";
  }
  return "unknown";
}

const char* name_of_action(std::uint16_t action) {
  switch (static_cast<Action>(action)) {
    case Action::home:
      return "home";
    case Action::grind_pass:
      return "grind_pass";
    case Action::retract:
      return "retract";
    case Action::move_column:
      return "move_column";
    case Action::clear_face:
      return "clear_face";
    case Action::stop:
      return "stop";
    case Action::reset_fault:
      return "reset_fault";
  }
  return "unknown";
}

}  // namespace biotomy::sim
