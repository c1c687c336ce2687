#include "firmware_bridge/lines/lines.hpp"

namespace biotomy::bridge {

const char* to_string(OutputRole role) {
  switch (role) {
    case OutputRole::lamp:
      return "lamp";
    case OutputRole::trigger:
      return "trigger";
    case OutputRole::tower_light:
      return "tower_light";
  }
  return "unknown";
}

}  // namespace biotomy::bridge
