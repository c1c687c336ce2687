#pragma once

#include <variant>

namespace biotomy::sim {

// What can break at the rig, a type each, with the word by which scenarios call it and
// what it means. What each does to the rig stands in rig_condition.cpp.

struct EstopPressed {
  static constexpr const char* kName = "estop_pressed";
  static constexpr const char* kMeaning = "somebody presses the e-stop";
};
struct DoorOpen {
  static constexpr const char* kName = "door_open";
  static constexpr const char* kMeaning = "the door stands open";
};
struct DoorBounces {
  static constexpr const char* kName = "door_bounces";
  static constexpr const char* kMeaning = "the door's contact opens again and again";
  double period_s = 0.5;
  double open_s = 0.02;  ///< of each period
};

struct LampDead {
  static constexpr const char* kName = "lamp_dead";
  static constexpr const char* kMeaning = "it gives no light, though it is on";
};
struct LampDims {
  static constexpr const char* kName = "lamp_dims";
  static constexpr const char* kMeaning = "it gives a part of its light";
  double share = 0.5;  ///< of the light that is left
};
struct LampFlickers {
  static constexpr const char* kName = "lamp_flickers";
  static constexpr const char* kMeaning = "its light swings between all of it and a part";
  double share = 0.5;  ///< of the light that is left at the darkest
  double frequency_hz = 3;
};

struct LampLightsUnevenly {
  static constexpr const char* kName = "lamp_uneven";
  static constexpr const char* kMeaning = "its light falls off over the face";
  double slope_x = 0.2;  ///< see LampField
  double slope_y = 0.0;
};
struct LampChangesColour {
  static constexpr const char* kName = "lamp_colour";
  static constexpr const char* kMeaning = "its light has another colour";
  double red = 1.1;  ///< factors of the light
  double green = 1.0;
  double blue = 0.9;
};

struct FaceFrosts {
  static constexpr const char* kName = "frost";
  static constexpr const char* kMeaning = "rime lies on parts of the face, which no air removes";
  double share = 0.3;  ///< see Frost
  double opacity = 0.4;
};
struct FaceGlares {
  static constexpr const char* kName = "glare";
  static constexpr const char* kMeaning = "spots of the face reflect the lamp";
  double share = 0.005;  ///< see Glare
};
struct BlockShifts {
  static constexpr const char* kName = "block_shifts";
  static constexpr const char* kMeaning = "the block slips in its holder, as the camera sees it";
  double x_um = 100;  ///< to the right
  double y_um = 0;    ///< down
};

struct CameraHangs {
  static constexpr const char* kName = "camera_hangs";
  static constexpr const char* kMeaning = "it photographs nothing and answers nothing";
};
struct CameraVanishes {
  static constexpr const char* kName = "camera_vanishes";
  static constexpr const char* kMeaning = "its connections are closed, and new ones too";
};
struct CameraGivesOldFrame {
  static constexpr const char* kName = "camera_old_frame";
  static constexpr const char* kMeaning = "the last photograph from before comes once more";
  bool under_old_number = false;
};
struct CameraTearsFrame {
  static constexpr const char* kName = "camera_torn_frame";
  static constexpr const char* kMeaning =
      "the upper part of the new photograph, the lower part of the last one from before";
  double share = 0.5;  ///< of the rows that are new
};
struct CameraGivesBlackFrame {
  static constexpr const char* kName = "camera_black_frame";
  static constexpr const char* kMeaning = "all is 0";
};
struct CameraGivesWrongSize {
  static constexpr const char* kName = "camera_wrong_size";
  static constexpr const char* kMeaning = "the photograph, scaled to another size";
  int width = 640;
  int height = 480;
};

struct ControllerPowerCut {
  static constexpr const char* kName = "controller_power_cut";
  static constexpr const char* kMeaning =
      "axes and program stop, the spindle runs down, nothing is answered; then it boots";
};
struct ControllerHeartbeatStops {
  static constexpr const char* kName = "controller_heartbeat_stops";
  static constexpr const char* kMeaning = "its heartbeat stands still, the rest goes on";
};
struct ModbusSilent {
  static constexpr const char* kName = "modbus_silent";
  static constexpr const char* kMeaning = "the controller goes on, but neither hears nor answers";
};
struct LinesSilent {
  static constexpr const char* kName = "lines_silent";
  static constexpr const char* kMeaning = "inputs and outputs are not answered";
};

enum class MachineAxis { feed, traverse, column };

struct AxisStalls {
  static constexpr const char* kName = "axis_stalls";
  static constexpr const char* kMeaning = "its motor turns no more, whatever it is told";
  MachineAxis axis = MachineAxis::feed;
};
struct AxisCreeps {
  static constexpr const char* kName = "axis_creeps";
  static constexpr const char* kMeaning = "it gives way, and its scale shows it";
  MachineAxis axis = MachineAxis::feed;
  double speed_um_s = 5;
};
struct AxisReadsWrong {
  static constexpr const char* kName = "axis_position_error";
  static constexpr const char* kMeaning = "its scale shows another position than the true one";
  MachineAxis axis = MachineAxis::feed;
  double error_um = 15;
};

struct SpindleOverloaded {
  static constexpr const char* kName = "spindle_overload";
  static constexpr const char* kMeaning = "it bears more than the cut";
  double load_percent = 150;  ///< beside what the cut takes
};
struct SpindleWontStart {
  static constexpr const char* kName = "spindle_wont_start";
  static constexpr const char* kMeaning = "it has no torque: it does not start, or runs down";
};
struct SpindleWontStop {
  static constexpr const char* kName = "spindle_wont_stop";
  static constexpr const char* kMeaning = "once it turns it turns on, whatever it is told";
};
struct GrindRemovesNothing {
  static constexpr const char* kName = "grind_removes_nothing";
  static constexpr const char* kMeaning = "the wheel does not touch";
};
struct GrindRemovesTooLittle {
  static constexpr const char* kName = "grind_removes_too_little";
  static constexpr const char* kMeaning = "the wheel reaches less deep than the feed says";
  double short_um = 10;  ///< of the depth that the feed says
};
struct DebrisSticks {
  static constexpr const char* kName = "debris_sticks";
  static constexpr const char* kMeaning = "the air blast reaches no debris";
};
struct VibrationFromOutside {
  static constexpr const char* kName = "vibration";
  static constexpr const char* kMeaning = "the camera shakes against the block: blur along x";
  double velocity_mm_s = 3;
};
struct CoolerFails {
  static constexpr const char* kName = "cooler_fails";
  static constexpr const char* kMeaning = "chamber and block warm towards the surroundings";
  double time_constant_s = 300;  ///< with which the chamber warms
};

using RigFault = std::variant<
    EstopPressed, DoorOpen, DoorBounces, LampDead, LampDims, LampFlickers, LampLightsUnevenly,
    LampChangesColour, FaceFrosts, FaceGlares, BlockShifts, CameraHangs, CameraVanishes,
    CameraGivesOldFrame, CameraTearsFrame, CameraGivesBlackFrame, CameraGivesWrongSize,
    ControllerPowerCut, ControllerHeartbeatStops, ModbusSilent, LinesSilent, AxisStalls, AxisCreeps,
    AxisReadsWrong, SpindleOverloaded, SpindleWontStart, SpindleWontStop, GrindRemovesNothing,
    GrindRemovesTooLittle, DebrisSticks, VibrationFromOutside, CoolerFails>;

/// The word by which scenarios call it.
const char* name_of(const RigFault& fault);

}  // namespace biotomy::sim
