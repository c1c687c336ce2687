#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include <opencv2/core/mat.hpp>

#include "acquisition/worker.hpp"
#include "firmware_bridge/camera/camera.hpp"
#include "firmware_bridge/device_error.hpp"
#include "firmware_bridge/lines/lines.hpp"
#include "firmware_bridge/stage/stage.hpp"

namespace biotomy::tests {

/// A controller that keeps the rules of docs/register-map.md, a few exchanges a command. The knobs
/// make it another.
struct FakeStage : bridge::Stage {
  bridge::StageIdentity identity{.map_version = 2,
                                 .watchdog_timeout = std::chrono::milliseconds(1000),
                                 .feed = {{0.0}, {50000.0}},
                                 .traverse = {{0.0}, {200000.0}},
                                 .column = {{0.0}, {10000.0}}};
  bridge::StageStatus status{};
  int exchanges_per_command = 2;

  int unanswered_identities = 0;        ///< so many times it does not say what it is
  bool silent = false;                  ///< no exchange and no command succeeds
  bool heart_stopped = false;           ///< controller_heartbeat stands still
  bool blind = false;                   ///< takes heartbeats and commands, and shows nothing
  bool wheel_runs_on = false;           ///< once it turns, whatever is commanded
  bool interlocked = false;             ///< refuses every command but stop
  bool stuck = false;                   ///< what is under way does not come to its end
  std::optional<double> feed_error_um;  ///< the wheel comes to rest beside its target
  /// An action whose next issue is not answered, whether it arrived all the same, and what shows
  /// that no answer came.
  struct LostAnswer {
    bridge::StageAction action;
    bool arrived;
    bridge::DeviceError::Kind seen_as = bridge::DeviceError::Kind::timeout;
  };
  std::optional<LostAnswer> lost_answer;
  std::optional<bridge::StageAction> ignored;  ///< is answered and starts nothing
  /// Called when a command arrives, before it is begun.
  std::function<void(const bridge::StageCommand&)> on_command = [](const auto&) {};

  std::function<void()> on_exchange = [] {};  ///< called as an exchange begins

  struct Executed {
    std::uint32_t sequence;
    bridge::StageCommand command;
  };
  std::vector<Executed> executed;         ///< every command that was begun
  std::vector<Executed> handed_over;      ///< every call of issue, arrived or not
  std::vector<std::uint16_t> heartbeats;  ///< of every exchange, answered or not

  FakeStage();
  bridge::StageIdentity identify() override;
  bridge::StageStatus look() override;
  bridge::StageStatus exchange(std::uint16_t heartbeat) override;
  void issue(std::uint32_t sequence, const bridge::StageCommand& command) override;

  /// It falls into a fault: what is under way is aborted, and the wheel stopped.
  void fault(std::uint16_t code);

  std::vector<double> ground() const;  ///< targets of the grind passes that were begun
  int count(bridge::StageAction action) const;

 private:
  void begin(std::uint32_t sequence, const bridge::StageCommand& command);
  bool refuses(const bridge::StageCommand& command) const;
  void end(std::uint32_t sequence, bridge::CommandResult result);
  void finish();
  void aim();

  std::optional<Executed> under_way_;
  int exchanges_left_ = 0;
};

struct FakeLines : bridge::Lines {
  bridge::SafetyInputs inputs{.estop_pressed = false, .door_open = false};
  std::set<bridge::OutputRole> on;

  bridge::SafetyInputs read_inputs() override { return inputs; }
  void set(bridge::OutputRole role, bool value) override;
};

/// Photographs the face that is ground, blurred by the column's distance from where it is sharp,
/// with noise of its own in every frame.
struct FakeCamera : bridge::Camera {
  FakeStage& stage;
  double column_to_face_um = 400.0;  ///< sharp where column = ground_to - this
  int width = 96;
  int height = 64;
  bool gone = false;
  int late_frames = 0;                  ///< so many of the next frames do not arrive in time
  std::string remark;                   ///< of its frames
  int black_frames = 0;                 ///< so many of the next frames are black
  double veil = 0.0;                    ///< pixels of blur that no focus takes away
  std::optional<double> stuck_face_um;  ///< shows the face of this depth, whatever is ground
  bool frozen = false;                  ///< gives its last picture again, with a new number
  int old_frames = 0;                   ///< so many of the next frames were exposed long ago
  int repeated_frames = 0;  ///< so many of the next frames have the number before theirs
  int captures = 0;
  std::optional<bridge::LensRange> lens;  ///< it can drive; then the lens focuses, not the column
  std::vector<double> lens_positions;     ///< where it was driven, dioptres

  explicit FakeCamera(FakeStage& rig_stage) : stage(rig_stage) {}
  bridge::CameraDescription describe() override;
  void apply(const bridge::CameraSettings& settings) override;
  bridge::Frame capture(std::chrono::milliseconds time_out) override;

 private:
  cv::Mat last_picture_;
};

/// Does what is posted at once, in the caller's thread.
struct InlineWorker : acquisition::Worker {
  bool at_work = false;                    ///< while a task is done, and what it holds is released
  std::function<void()> at_edges = [] {};  ///< called before each task and after it
  void post(std::function<void()> task) override {
    at_edges();
    const bool before = std::exchange(at_work, true);
    task();
    task = nullptr;
    at_work = before;
    at_edges();
  }
};

/// Keeps what is posted until a test lets it go on.
struct HeldWorker : acquisition::Worker {
  std::vector<std::function<void()>> tasks;
  void post(std::function<void()> task) override { tasks.push_back(std::move(task)); }
  void run();
};

/// Squares of 4 pixels in two colours, smoothed by a Gaussian of `sigma` pixels; CV_8UC3.
cv::Mat chequered_face(int width, int height, double sigma);

/// The same with tones that differ from square to square and have nothing in common from depth to
/// depth.
cv::Mat ground_face(int width, int height, double sigma, double depth_um);

/// Adds noise of about a level; another for every number.
void add_noise(cv::Mat& image, std::uint64_t number);

}  // namespace biotomy::tests
