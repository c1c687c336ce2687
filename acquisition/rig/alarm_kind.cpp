#include "acquisition/rig/alarm_kind.hpp"

namespace biotomy::acquisition {

const char* to_string(AlarmKind kind) {
  switch (kind) {
    case AlarmKind::start_latch:
      return "start_latch";
    case AlarmKind::emergency_stop:
      return "emergency_stop";
    case AlarmKind::door:
      return "door";
    case AlarmKind::lines:
      return "lines";
    case AlarmKind::controller:
      return "controller";
    case AlarmKind::watchdog:
      return "watchdog";
    case AlarmKind::link:
      return "link";
    case AlarmKind::wheel:
      return "wheel";
    case AlarmKind::motion:
      return "motion";
    case AlarmKind::temperature:
      return "temperature";
    case AlarmKind::disk:
      return "disk";
    case AlarmKind::disagreement:
      return "disagreement";
    case AlarmKind::preflight:
      return "preflight";
    case AlarmKind::camera:
      return "camera";
    case AlarmKind::focus:
      return "focus";
    case AlarmKind::storage:
      return "storage";
    case AlarmKind::time_limit:
      return "time_limit";
    case AlarmKind::ending:
      return "ending";
  }
  return "?";
}

const char* advice(AlarmKind kind) {
  switch (kind) {
    case AlarmKind::start_latch:
      return "Look at the rig. If it is as it should be, start the job or acknowledge.";
    case AlarmKind::emergency_stop:
      return "Find out why it was pressed, release it, then acknowledge and resume. If nobody "
             "pressed it, look for a loose contact or a noisy cable.";
    case AlarmKind::door:
      return "Close the door, then acknowledge and resume. If nobody opened it, look for a loose "
             "contact or a noisy cable.";
    case AlarmKind::lines:
      return "Look at the GPIO chip and its cable: without them e-stop and door count as open. "
             "Then acknowledge and resume.";
    case AlarmKind::controller:
      return "Read the fault at the controller and remove its cause. Then acknowledge, which "
             "resets it, and resume.";
    case AlarmKind::watchdog:
      return "The controller stopped by itself because it did not hear this program in time. Look "
             "at the network and the computer's load, then acknowledge and resume.";
    case AlarmKind::link:
      return "Look at the controller's power and at the cable or network to it. Then acknowledge "
             "and resume.";
    case AlarmKind::wheel:
      return "Look at the wheel: is it worn, loose or clogged, is the block fixed? Then "
             "acknowledge and resume.";
    case AlarmKind::motion:
      return "Look for what holds or moves the axis, and whether block and wheel are where they "
             "should be. Then acknowledge and resume.";
    case AlarmKind::temperature:
      return "Look at the cooling. Once the block is in its window again, acknowledge and resume.";
    case AlarmKind::disk:
      return "Make room on the disk, then acknowledge and resume.";
    case AlarmKind::disagreement:
      return "Do not grind: compare the block with the last stored layer, and the controller's "
             "counter and depth with what the cause says. Set right what is wrong, then "
             "acknowledge and resume.";
    case AlarmKind::preflight:
      return "Set right what the cause names, then acknowledge and resume.";
    case AlarmKind::camera:
      return "Look at the camera, its cable and the lamp. Then acknowledge and resume: the layer "
             "is photographed again, never ground again.";
    case AlarmKind::focus:
      return "Look whether lens, face and light are clean and as they were. Then acknowledge and "
             "resume; or acknowledge, abort and calibrate the focus, which says what to set.";
    case AlarmKind::storage:
      return "Look at the disk: is it full, read-only or broken? Then acknowledge and resume: "
             "what was not stored is photographed again.";
    case AlarmKind::time_limit:
      return "Look at what the cause says it waited for. Then acknowledge and resume.";
    case AlarmKind::ending:
      return "Look at the rig: it was stopped where it was. Then acknowledge and resume.";
  }
  return "";
}

}  // namespace biotomy::acquisition
