#include "tests/kernel/remote_rig.hpp"

#include <chrono>

namespace biotomy::tests {

namespace {

constexpr int kCables = 3;

}  // namespace

RemoteRig::RemoteRig(const RigPlan& plan) : rig_(plan) {}

std::vector<std::string> RemoteRig::plugged_in(const std::filesystem::path& folder) {
  const auto frames = folder / "frames";
  std::filesystem::remove_all(frames);
  std::filesystem::create_directories(frames);
  const auto controller = std::filesystem::canonical(rig_.folder() / "serial-line");
  std::vector<std::string> options{"ssl0=tty:" + controller.string()};
  cables_.clear();
  for (int i = 1; i <= kCables; ++i) {
    options.push_back("ssl" + std::to_string(i) + "=tty:" + lay_cable(frames));
  }
  return options;
}

std::string RemoteRig::lay_cable(const std::filesystem::path& frames) {
  cables_.push_back(std::make_unique<ChildProcess>(
      std::vector<std::string>{BIOTOMY_RIG_CABLE, "--rig", rig_.folder() / "rig.socket", "--folder",
                               std::filesystem::absolute(frames)},
      rig_.folder()));
  return cables_.back()->wait_for("at ", std::chrono::seconds(20));
}

}  // namespace biotomy::tests
