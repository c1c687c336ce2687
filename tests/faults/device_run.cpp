#include "tests/faults/device_run.hpp"

#include <cstdint>

#include <nlohmann/json.hpp>

#include "acquisition/records/utc_time.hpp"

namespace biotomy::tests {

RigPlan device_plan(int layers) {
  RigPlan plan{.width = 160, .height = 120, .layers = layers, .time_scale = 100};
  plan.daemon_camera_settings = "capture_timeout_ms = 300\n";
  plan.daemon_settings = "commands_per_minute = 10000\n";
  return plan;
}

const std::filesystem::path& undisturbed_device_sample() {
  static UndisturbedRun run(device_plan(kMostDeviceLayers));
  static const std::filesystem::path sample = run.sample();
  return sample;
}

DeviceRun::DeviceRun(const RigPlan& plan)
    : job_(plan), bench_(job_.rig().folder() / "rig.socket"), watch_([this] {
        job_.go_on();
        return job_.rig().url();
      }()) {}

std::chrono::milliseconds DeviceRun::recover(const nlohmann::json& stopped) {
  const auto begin = std::chrono::steady_clock::now();
  job_.go_on();
  watch_.await_committed(stopped.at("committed").get<std::int64_t>() + 1);
  return std::chrono::round<std::chrono::milliseconds>(std::chrono::steady_clock::now() - begin);
}

std::string now_utc() {
  return acquisition::utc_text(std::chrono::system_clock::now());
}

}  // namespace biotomy::tests
