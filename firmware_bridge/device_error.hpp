#pragma once

#include <stdexcept>
#include <string>

namespace biotomy::bridge {

/// A device that could not do what was asked. The message names the device, what was wrong and what
/// to do. `kind` tells the caller whether asking again can help.
class DeviceError : public std::runtime_error {
 public:
  enum class Kind {
    timeout,  ///< no answer in time; the device may or may not have acted: read back, then decide
    disconnected,   ///< the connection is gone; a later call tries to connect anew
    refused,        ///< the device answered no (illegal address, value out of range)
    configuration,  ///< it can never work as configured (wrong map, unknown camera, missing line)
  };

  DeviceError(Kind kind, const std::string& message) : std::runtime_error(message), kind_(kind) {}
  Kind kind() const { return kind_; }

 private:
  Kind kind_;
};

}  // namespace biotomy::bridge
