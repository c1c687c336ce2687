#include "sim/service/twin.hpp"

#include <chrono>
#include <condition_variable>
#include <future>
#include <mutex>

namespace biotomy::sim {

namespace {

using Clock = std::chrono::steady_clock;
using namespace std::chrono_literals;

constexpr auto kTick = 2ms;

/// Waits for `duration`, less if stopped.
void wait(const std::stop_token& stop, std::chrono::microseconds duration) {
  std::mutex mutex;
  std::condition_variable_any never;
  std::unique_lock lock(mutex);
  never.wait_for(lock, stop, duration, [] { return false; });
}

}  // namespace

Twin::Twin(const Configuration& configuration)
    : configuration_(configuration),
      witness_(configuration.witness_log, std::chrono::system_clock::now),
      phantom_(configuration.phantom),
      rig_(configuration.rig, StateFile(configuration.state_file), witness_, Clock::now()),
      camera_service_(configuration.camera_model,
                      Camera(configuration.rig.seed, phantom_, configuration.first_face_um,
                             configuration.optics, configuration.sensor),
                      configuration.optics, rig_, witness_, camera_time()),
      line_service_(rig_),
      bench_service_(rig_),
      modbus_server_(make_modbus_server(configuration.stage_listen, configuration.stage_serial,
                                        bridge::RegisterMap::read_file(configuration.register_map),
                                        rig_)),
      rig_server_(configuration.rig_socket, {{bridge::RigService::camera, &camera_service_},
                                             {bridge::RigService::lines, &line_service_},
                                             {bridge::RigService::bench, &bench_service_}}) {}

std::string Twin::rig_address() const {
  return "unix://" + configuration_.rig_socket.string();
}

CameraTime Twin::camera_time() const {
  return {Clock::now, [stop = stopping_.get_token()](std::chrono::microseconds duration) {
            wait(stop, duration);
          }};
}

void Twin::run(const std::stop_token& stop) {
  const std::stop_callback forward(stop, [this] { stopping_.request_stop(); });
  const std::stop_token stopping = stopping_.get_token();
  const auto serve = [&](auto& server) {
    return std::async(std::launch::async, [this, &server, stopping] {
      try {
        server.run(stopping);
      } catch (...) {
        stopping_.request_stop();  // the others have to end, too
        throw;
      }
    });
  };
  std::future<void> modbus = serve(*modbus_server_);
  std::future<void> rig = serve(rig_server_);
  // However this ends, the servers end before their futures wait for them.
  const struct StopAtEnd {
    std::stop_source& source;
    ~StopAtEnd() { source.request_stop(); }
  } stop_at_end{stopping_};

  while (!stopping.stop_requested()) {
    rig_.advance(Clock::now());
    wait(stopping, kTick);
  }
  modbus.get();
  rig.get();
  rig_.keep_state();
}

}  // namespace biotomy::sim
