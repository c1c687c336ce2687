#include "firmware_bridge/lines/input_debounce.hpp"

namespace biotomy::bridge {

bool InputDebounce::look(bool had_edges, bool is_active, TimePoint now) {
  if (had_edges || is_active) {
    unrest_ = now;
    return true;
  }
  return unrest_ && now - *unrest_ < period_;
}

}  // namespace biotomy::bridge
