#pragma once

#include <optional>
#include <string>

#include "acquisition/rig/step_failure.hpp"
#include "firmware_bridge/lines/lines.hpp"
#include "firmware_bridge/stage/stage.hpp"

namespace biotomy::acquisition {

/// Compares the two ways in which e-stop and door are seen, the lines and the controller. Either of
/// them stops the rig, so that one of them may be dead for years unseen; but for as long as a
/// switch is pressed or open, they must say the same.
class ChannelComparison {
 public:
  void observe(const bridge::Interlocks& by_controller, const bridge::SafetyInputs& by_lines,
               TimePoint now);

  /// That one of the two has not seen for two seconds what the other one sees. Said once, until
  /// they agree again.
  std::optional<std::string> take_disagreement();

 private:
  struct Switch {
    std::optional<TimePoint> since;  ///< they disagree
    bool line_sees_it = false;
    bool is_told = false;
    void observe(bool by_controller, bool by_line, TimePoint now);
  };

  Switch estop_;
  Switch door_;
  TimePoint now_{};
};

}  // namespace biotomy::acquisition
