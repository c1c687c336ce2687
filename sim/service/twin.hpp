#pragma once

#include <memory>
#include <stop_token>
#include <string>

#include "sim/control/modbus_server.hpp"
#include "sim/phantom/phantom.hpp"
#include "sim/service/bench_service.hpp"
#include "sim/service/camera_service.hpp"
#include "sim/service/configuration.hpp"
#include "sim/service/line_service.hpp"
#include "sim/service/rig.hpp"
#include "sim/service/rig_server.hpp"
#include "sim/service/witness_log.hpp"

namespace biotomy::sim {

/// The twin, wired up: rig, controller's Modbus side, camera and lines. It listens once it is
/// constructed; nothing moves before run().
class Twin {
 public:
  /// Throws with one line if a file or an address can't be had.
  explicit Twin(const Configuration& configuration);

  /// "tcp://127.0.0.1:1502", with the port that was found, or "rtu:///path".
  const std::string& stage_address() const { return modbus_server_->address(); }
  std::string rig_address() const;

  /// Runs in real time until stopped, then keeps the state and ends within a tenth of a second.
  /// What goes wrong inside (a full disk, say) ends it by an exception. Called once.
  void run(const std::stop_token& stop);

 private:
  CameraTime camera_time() const;

  Configuration configuration_;
  std::stop_source stopping_;
  WitnessLog witness_;
  Phantom phantom_;
  Rig rig_;
  CameraService camera_service_;
  LineService line_service_;
  BenchService bench_service_;
  std::unique_ptr<ModbusServer> modbus_server_;
  RigServer rig_server_;
};

}  // namespace biotomy::sim
