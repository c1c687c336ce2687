#include "firmware_bridge/stage/stage.hpp"

namespace biotomy::bridge {

const char* to_string(ControllerState state) {
  switch (state) {
    case ControllerState::booting:
      return "booting";
    case ControllerState::idle:
      return "idle";
    case ControllerState::busy:
      return "busy";
    case ControllerState::faulted:
      return "faulted";
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

const char* to_string(StageAction action) {
  switch (action) {
    case StageAction::home:
      return "home";
    case StageAction::grind_pass:
      return "grind_pass";
    case StageAction::retract:
      return "retract";
    case StageAction::move_column:
      return "move_column";
    case StageAction::clear_face:
      return "clear_face";
    case StageAction::stop:
      return "stop";
    case StageAction::reset_fault:
      return "reset_fault";
  }
  return "unknown";
}

}  // namespace biotomy::bridge
