#include "tests/acquisition/fake_rig.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <opencv2/imgproc.hpp>

namespace biotomy::tests {

using bridge::CommandResult;
using bridge::ControllerState;
using bridge::DeviceError;
using bridge::StageAction;

namespace {

constexpr double kTraverseAfterPassUm = 80000.0;
constexpr std::uint16_t kWatchdogFault = 3;

}  // namespace

FakeStage::FakeStage() {
  status.state = ControllerState::idle;
  status.interlocks = {
      .estop_pressed = false, .door_open = false, .watchdog_tripped = false, .homed = false};
  status.block_temperature_c = -30.0;
  status.chamber_temperature_c = -25.0;
}

bridge::StageIdentity FakeStage::identify() {
  const bool unanswered = silent || unanswered_identities > 0;
  unanswered_identities = std::max(0, unanswered_identities - 1);
  if (unanswered) throw DeviceError(DeviceError::Kind::timeout, "stage: no answer");
  return identity;
}

bridge::StageStatus FakeStage::look() {
  if (silent || blind) throw DeviceError(DeviceError::Kind::timeout, "stage: no answer");
  if (!heart_stopped) ++status.controller_heartbeat;
  if (under_way_ && !stuck && --exchanges_left_ <= 0) finish();
  aim();
  return status;
}

bridge::StageStatus FakeStage::exchange(std::uint16_t heartbeat) {
  heartbeats.push_back(heartbeat);
  on_exchange();
  return look();
}

void FakeStage::issue(std::uint32_t sequence, const bridge::StageCommand& command) {
  handed_over.push_back({sequence, command});
  if (silent) throw DeviceError(DeviceError::Kind::timeout, "stage: no answer");
  if (lost_answer && lost_answer->action == command.action) {
    const LostAnswer lost = *std::exchange(lost_answer, std::nullopt);
    if (lost.arrived) begin(sequence, command);
    throw DeviceError(lost.seen_as, "stage: no answer");
  }
  begin(sequence, command);
}

void FakeStage::begin(std::uint32_t sequence, const bridge::StageCommand& command) {
  if (sequence <= status.sequence_started || command.action == ignored) return;
  const bool busy = under_way_ || status.state == ControllerState::busy;
  if (busy && command.action != StageAction::stop) {
    throw DeviceError(DeviceError::Kind::refused, "stage: it is busy");
  }
  on_command(command);
  if (under_way_) end(under_way_->sequence, CommandResult::aborted);
  executed.push_back({sequence, command});
  status.sequence_started = sequence;
  if (refuses(command)) {
    end(sequence, CommandResult::refused);
    return;
  }
  under_way_ = Executed{sequence, command};
  exchanges_left_ = command.action == StageAction::stop ? 1 : exchanges_per_command;
  if (status.state != ControllerState::faulted) status.state = ControllerState::busy;
}

bool FakeStage::refuses(const bridge::StageCommand& command) const {
  if (command.action == StageAction::stop) return false;
  if (interlocked) return true;
  if (command.action == StageAction::reset_fault) {
    return status.interlocks.estop_pressed || status.interlocks.door_open;
  }
  return status.state == ControllerState::faulted;
}

void FakeStage::end(std::uint32_t sequence, CommandResult result) {
  under_way_.reset();
  status.last_result = result;
  status.sequence_finished = sequence;
}

void FakeStage::fault(std::uint16_t code) {
  if (under_way_) end(under_way_->sequence, CommandResult::aborted);
  status.state = ControllerState::faulted;
  status.fault_code = code;
  status.interlocks.watchdog_tripped = code == kWatchdogFault;
  if (!wheel_runs_on) status.spindle_rpm = 0.0;
}

void FakeStage::finish() {
  const Executed done = *under_way_;
  end(done.sequence, CommandResult::done);
  const bool stays_faulted =
      status.state == ControllerState::faulted && done.command.action != StageAction::reset_fault;
  if (!stays_faulted) status.state = ControllerState::idle;
  if (!wheel_runs_on) status.spindle_rpm = done.command.spindle_rpm;
  switch (done.command.action) {
    case StageAction::home:
      status.interlocks.homed = true;
      break;
    case StageAction::grind_pass:
      status.feed = done.command.position + bridge::Micrometres{feed_error_um.value_or(0.0)};
      status.ground_to = std::max(status.ground_to, status.feed);
      ++status.grind_count;
      status.traverse = {kTraverseAfterPassUm};
      break;
    case StageAction::retract:
      status.traverse = {0.0};
      break;
    case StageAction::move_column:
      status.column = done.command.position;
      break;
    case StageAction::reset_fault:
      status.interlocks.watchdog_tripped = false;
      status.fault_code = 0;
      break;
    case StageAction::clear_face:
    case StageAction::stop:
      break;
  }
}

void FakeStage::aim() {
  status.feed_target = status.feed;
  status.traverse_target = status.traverse;
  status.column_target = status.column;
  if (!under_way_) return;
  const bridge::StageCommand& command = under_way_->command;
  if (command.action == StageAction::grind_pass) {
    status.feed_target = command.position;
    status.traverse_target = {kTraverseAfterPassUm};
  } else if (command.action == StageAction::retract) {
    status.traverse_target = {0.0};
  } else if (command.action == StageAction::move_column) {
    status.column_target = command.position;
  }
}

std::vector<double> FakeStage::ground() const {
  std::vector<double> targets;
  for (const Executed& entry : executed) {
    if (entry.command.action == StageAction::grind_pass) {
      targets.push_back(entry.command.position.value);
    }
  }
  return targets;
}

int FakeStage::count(StageAction action) const {
  return static_cast<int>(std::count_if(executed.begin(), executed.end(), [&](const auto& entry) {
    return entry.command.action == action;
  }));
}

void FakeLines::set(bridge::OutputRole role, bool value) {
  if (value) {
    on.insert(role);
  } else {
    on.erase(role);
  }
}

bridge::CameraDescription FakeCamera::describe() {
  if (gone) throw DeviceError(DeviceError::Kind::disconnected, "camera: gone");
  return {.model = "fake",
          .width = width,
          .height = height,
          .lens = lens,
          .transfer = bridge::Transfer::linear};
}

void FakeCamera::apply(const bridge::CameraSettings& settings) {
  if (!settings.lens_position) return;
  if (!lens) throw DeviceError(DeviceError::Kind::refused, "camera: no lens");
  lens_positions.push_back(*settings.lens_position);
}

bridge::Frame FakeCamera::capture(std::chrono::milliseconds) {
  if (gone) throw DeviceError(DeviceError::Kind::disconnected, "camera: gone");
  ++captures;
  if (late_frames > 0) {
    --late_frames;
    throw DeviceError(DeviceError::Kind::timeout, "camera: no packet in time");
  }
  const double plane =
      lens_positions.empty() ? stage.status.column.value : 1e6 / lens_positions.back();
  const double defocus = std::abs(stage.status.ground_to.value - column_to_face_um - plane);
  bridge::Frame frame;
  constexpr double kNothingLeft = 50.0;  // pixels of blur; more would take long and look the same
  frame.image = ground_face(width, height, std::min(0.5 + veil + defocus / 20.0, kNothingLeft),
                            stuck_face_um.value_or(stage.status.ground_to.value));
  add_noise(frame.image, static_cast<std::uint64_t>(captures));
  if (black_frames > 0) {
    --black_frames;
    frame.image.setTo(cv::Scalar::all(1));
  }
  if (frozen) frame.image = last_picture_.clone();
  last_picture_ = frame.image.clone();
  frame.sequence = static_cast<std::uint64_t>(captures);
  if (repeated_frames > 0) {
    --repeated_frames;
    --frame.sequence;
  }
  if (old_frames > 0) {
    --old_frames;
    frame.sensor_timestamp = std::chrono::nanoseconds(1);
  }
  frame.exposure = std::chrono::microseconds(10000);
  frame.gain = 1.0;
  frame.remark = remark;
  return frame;
}

void HeldWorker::run() {
  for (auto& task : std::exchange(tasks, {})) task();
}

cv::Mat chequered_face(int width, int height, double sigma) {
  cv::Mat face(height, width, CV_8UC3);
  for (int row = 0; row < height; ++row) {
    for (int column = 0; column < width; ++column) {
      const bool light = (row / 4 + column / 4) % 2 == 0;
      face.at<cv::Vec3b>(row, column) = light ? cv::Vec3b(200, 120, 110) : cv::Vec3b(90, 60, 50);
    }
  }
  cv::Mat blurred;
  cv::GaussianBlur(face, blurred, {}, sigma);
  return blurred;
}

cv::Mat ground_face(int width, int height, double sigma, double depth_um) {
  cv::RNG tones(static_cast<std::uint64_t>(std::llround(depth_um * 10.0)) + 1);
  cv::Mat squares((height + 3) / 4, (width + 3) / 4, CV_32F);
  tones.fill(squares, cv::RNG::UNIFORM, 0.75, 1.25);
  cv::Mat face = chequered_face(width, height, 0.01);
  for (int row = 0; row < height; ++row) {
    for (int column = 0; column < width; ++column) {
      auto& pixel = face.at<cv::Vec3b>(row, column);
      pixel = cv::Vec3b(squares.at<float>(row / 4, column / 4) * cv::Vec3f(pixel));
    }
  }
  cv::GaussianBlur(face, face, {}, sigma);
  return face;
}

void add_noise(cv::Mat& image, std::uint64_t number) {
  cv::Mat noise(image.size(), CV_16SC3);
  cv::RNG(number + 1).fill(noise, cv::RNG::NORMAL, 0.0, 0.7);
  cv::add(image, noise, image, {}, image.type());
}

}  // namespace biotomy::tests
