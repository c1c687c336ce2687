#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "firmware_bridge/wire/checked_table.hpp"
#include "sim/scenario/rig_fault.hpp"

namespace biotomy::sim {

/// When something breaks: at a moment that the rig comes to, and after a delay.
struct Occasion {
  enum class Moment {
    rig_time,       ///< seconds of the rig since the twin started
    grind_started,  ///< the grind pass of a layer; layers count from 1, over restarts
    grind_finished,
    capture,  ///< a photograph, before it is taken; photographs count from 1 since the start
  };
  Moment moment = Moment::rig_time;
  double at = 0;           ///< seconds, or the number of the layer or photograph
  double every = 0;        ///< again after so many of them; 0: once
  double delay_s = 0;      ///< rig time from the moment on
  double probability = 1;  ///< that it happens, drawn anew for each occasion
};

/// How long it stays broken; for good if nothing says otherwise.
struct Duration {
  std::optional<double> rig_seconds{};
  std::optional<double> real_seconds{};
  std::optional<int> captures{};  ///< photographs that are asked for
  std::optional<int> grinds{};    ///< grind passes that end, in whichever way
  bool until_reset = false;       ///< mended as the controller is given `reset_fault`
};

struct ScenarioEvent {
  std::string name;
  RigFault fault;
  Occasion when{};
  Duration lasts{};
};

/// What breaks in the course of a run: a TOML file (README.md).
struct Scenario {
  std::string about;
  std::vector<ScenarioEvent> events;
};

/// Throws bridge::ConfigurationError with file, line, key and what was expected.
Scenario read_scenario(const bridge::CheckedTable& file);

/// One event, written as in a scenario's table; `text` is TOML. Throws bridge::ConfigurationError.
ScenarioEvent parse_event(const std::string& name, std::string_view text);

}  // namespace biotomy::sim
