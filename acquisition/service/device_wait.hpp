#pragma once

#include <chrono>
#include <functional>
#include <string>
#include <type_traits>

#include "acquisition/rig/step_failure.hpp"
#include "acquisition/service/service_manager.hpp"
#include "firmware_bridge/device_error.hpp"

namespace biotomy::acquisition {

/// Waits for devices that come later than the daemon, as after a power cut: each is tried again
/// every few seconds until the time is up. Log and systemd are told which one is missing.
class DeviceWait {
 public:
  using Clock = std::function<TimePoint()>;
  /// Lets the time pass; true when the daemon is to end.
  using Pause = std::function<bool(std::chrono::milliseconds)>;

  /// The time is that for all devices together, from now on.
  DeviceWait(std::chrono::milliseconds limit, ServiceManager& systemd, Clock clock, Pause pause);

  /// The device that `make` gives; null when the daemon is to end before it is there. Throws the
  /// last DeviceError when the time is up, and at once whatever else `make` throws.
  template <typename Make>
  std::invoke_result_t<Make> device(Make make) {
    for (;;) {
      try {
        return make();
      } catch (const bridge::DeviceError& missing) {
        if (clock_() >= until_) throw;
        tell(missing.what());
      }
      if (pause_(kBetweenTries)) return nullptr;
    }
  }

 private:
  static constexpr std::chrono::milliseconds kBetweenTries{3000};

  void tell(const std::string& missing);

  ServiceManager& systemd_;
  Clock clock_;
  Pause pause_;
  TimePoint until_;
  std::string told_;
};

}  // namespace biotomy::acquisition
