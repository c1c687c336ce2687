#pragma once

#include <optional>
#include <vector>

#include "sim/physics/face_painter.hpp"
#include "sim/physics/lamp_field.hpp"
#include "sim/physics/machine_defects.hpp"
#include "sim/physics/surface_film.hpp"
#include "sim/scenario/schedule.hpp"

namespace biotomy::sim {

/// What is wrong with the camera.
struct CameraCondition {
  bool hangs = false;
  bool vanished = false;
  bool gives_old_frame = false;
  bool gives_old_number = false;    ///< with it
  std::optional<double> torn_at{};  ///< share of the rows that are new
  bool gives_black_frame = false;
  struct Size {
    int width = 0;
    int height = 0;
  };
  std::optional<Size> wrong_size{};

  bool answers() const { return !hangs && !vanished; }

  /// What it gives is not what it photographed: one that the daemon should not believe.
  bool spoils_frames() const {
    return gives_old_frame || torn_at || gives_black_frame || wrong_size;
  }
};

/// What is wrong with the rig as a whole: the knobs that its parts offer, turned by the faults that
/// last. By default all is well.
struct RigCondition {
  MachineDefects machine;
  CameraCondition camera;
  bool estop_pressed = false;
  bool door_open = false;
  double lamp_share = 1;  ///< of the light that the lamp gives while it is on
  LampField lamp_field;
  SurfaceFilm film;
  Displacement displacement;  ///< of the block in its holder
  bool controller_powered = true;
  bool controller_heartbeat_stopped = false;
  bool modbus_silent = false;
  bool lines_silent = false;
};

/// The condition at a time of the rig.
RigCondition condition_of(const std::vector<ActiveFault>& faults, double rig_s);

}  // namespace biotomy::sim
