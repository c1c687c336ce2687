#pragma once

#include <cstdint>

#include "sim/control/controller_registers.hpp"

namespace biotomy::sim {

/// What the controller's Modbus side needs of the rig. Called from the server's thread.
class ControllerPort {
 public:
  virtual ~ControllerPort() = default;
  /// False while nothing that comes is heard or answered.
  virtual bool answers() const = 0;
  virtual ControllerReading read() = 0;
  virtual void hear_master(std::uint16_t heartbeat) = 0;
  virtual Acceptance submit(const Command& command) = 0;
};

}  // namespace biotomy::sim
