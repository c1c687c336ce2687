#pragma once

namespace biotomy::acquisition {

/// What a rejected photograph leads to.
struct LadderSettings {
  int max_attempts = 4;  ///< frames of one layer, before a person is asked
  enum class Exhausted { pause, accept } exhausted = Exhausted::pause;
  int flagged_in_a_row = 3;  ///< layers that are accepted with a flag, before a person is asked
};

}  // namespace biotomy::acquisition
