#pragma once

#include <string>

namespace biotomy::acquisition {

/// What an alarm is about, as far as it decides what a person has to do.
enum class AlarmKind {
  start_latch,     ///< nothing happened: the daemon has just started
  emergency_stop,  ///< pressed
  door,            ///< open
  lines,           ///< e-stop and door cannot be read
  controller,      ///< faulted, or it answered a command with a refusal
  watchdog,        ///< the controller missed the daemon
  link,            ///< the controller does not answer, or its program stands still
  wheel,           ///< spindle load or vibration
  motion,          ///< an axis is not where it should be, or does not move
  temperature,
  disk,          ///< no room
  disagreement,  ///< journal and controller tell different stories
  preflight,     ///< something was not fit before the job could begin
  camera,
  focus,
  storage,     ///< an image or a record was not written
  time_limit,  ///< a step took too long
  ending       ///< the daemon was stopped before the rig was at rest
};

/// Its name: "emergency_stop".
const char* to_string(AlarmKind kind);

/// Why the wheel must stop.
struct StopCause {
  AlarmKind kind = AlarmKind::controller;
  std::string sentence;
};

/// What a person should do about such an alarm, in a sentence or two.
const char* advice(AlarmKind kind);

}  // namespace biotomy::acquisition
