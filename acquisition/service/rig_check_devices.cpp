#include "acquisition/service/rig_check_devices.hpp"

#include <array>
#include <cstdio>
#include <exception>
#include <string>

#include <opencv2/core.hpp>

#include "acquisition/calibration/corrected_camera.hpp"
#include "acquisition/number_text.hpp"
#include "acquisition/rig/capture.hpp"
#include "acquisition/rig/supervision.hpp"
#include "acquisition/service/gpio_complaints.hpp"
#include "firmware_bridge/device_error.hpp"
#include "firmware_bridge/lines/gpio_chips.hpp"

namespace biotomy::acquisition {
namespace {

using std::chrono::milliseconds;

constexpr const char* kController = "controller";
constexpr const char* kLines = "lines";
constexpr const char* kCamera = "camera";
constexpr const char* kCalibration = "calibration";
constexpr milliseconds kLook{50};     // between two looks at the controller's heartbeat
constexpr milliseconds kSettle{150};  // for inputs that are debounced

std::string range_text(const char* axis, const bridge::AxisLimits& limits) {
  return std::string(axis) + " " + number_text(limits.minimum.value) + " to " +
         number_text(limits.maximum.value) + " µm";
}

std::string fraction_text(double value) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.3f", value);
  return text.data();
}

std::string position_text(const bridge::StageStatus& status) {
  return std::string(bridge::to_string(status.state)) + ", " +
         (status.interlocks.homed ? "homed" : "not homed") + "; feed at " +
         number_text(status.feed.value) + " µm, traverse at " + number_text(status.traverse.value) +
         " µm, column at " + number_text(status.column.value) + " µm; ground to " +
         number_text(status.ground_to.value) + " µm in " + std::to_string(status.grind_count) +
         " passes; block at " + number_text(status.block_temperature_c) + " °C";
}

/// As used; a camera that does not tell gives 0.
std::string exposure_text(const bridge::Frame& frame) {
  const bool told = frame.exposure.count() > 0;
  return (told ? "exposure " + std::to_string(frame.exposure.count()) + " µs"
               : std::string("exposure not told")) +
         (frame.gain > 0.0 ? ", gain " + number_text(frame.gain) : ", gain not told");
}

/// Asks the devices one after the other; what one throws is its finding.
class DeviceCheck {
 public:
  DeviceCheck(const Configuration& configuration, const RigCheckParts& parts, RigFindings& findings)
      : configuration_(configuration),
        job_(configuration.job),
        parts_(parts),
        findings_(findings) {}

  AnsweredRig run() {
    attempt(kController, [&] { ask_controller(); });
    attempt(kLines, [&] { ask_lines(); });
    attempt(kCamera, [&] { ask_camera(); });
    return rig_;
  }

 private:
  template <typename Action>
  bool attempt(const char* part, Action action) {
    try {
      action();
      return true;
    } catch (const std::exception& error) {
      findings_.wrong(part, error.what());
      return false;
    }
  }

  void ask_controller() {
    const std::shared_ptr<bridge::Stage> stage = parts_.make_stage();
    const bridge::StageIdentity identity = stage->identify();
    findings_.good(kController, configuration_.stage.endpoint + ": version " +
                                    std::to_string(identity.map_version) +
                                    " of the register map, watches the daemon by " +
                                    std::to_string(identity.watchdog_timeout.count()) + " ms; " +
                                    range_text("feed", identity.feed) + ", " +
                                    range_text("traverse", identity.traverse) + ", " +
                                    range_text("column", identity.column));
    const Complaints complaints = stage_complaints(job_, identity);
    findings_.wrong(kController, complaints);
    if (complaints.empty()) findings_.good("plan", plan_text());
    watch(*stage);
  }

  std::string plan_text() const {
    const JobPlan& plan = job_.plan;
    std::string text = "layers 1 to " + std::to_string(plan.layers) + " at " +
                       number_text(plan.face_of(1).value) + " to " +
                       number_text(plan.face_of(plan.layers).value) + " µm of the feed";
    if (job_.focus.actuator == FocusSettings::Actuator::column) {
      text += ", their focus from " + number_text(job_.focus.start.value) + " µm of the column on";
    }
    return text + ": within the limits";
  }

  /// Until its heartbeat has been seen to beat, or for so long as a job lets it be silent.
  void watch(bridge::Stage& stage) {
    Supervision supervision(job_.limits);
    const bridge::SafetyInputs no_lines{.estop_pressed = false, .door_open = false};
    const TimePoint began = parts_.now();
    bridge::StageStatus status = stage.look();
    supervision.observe(status, no_lines, began);
    const std::uint16_t first_beat = status.controller_heartbeat;
    while (status.controller_heartbeat == first_beat &&
           parts_.now() - began <= job_.limits.controller_silent) {
      parts_.wait(kLook);
      status = stage.look();
      supervision.observe(status, no_lines, parts_.now());
    }
    rig_.controller = status;
    findings_.good(kController, position_text(status));
    if (const auto cause = supervision.standing_cause()) {
      findings_.wrong(kController, cause->sentence);
    } else if (const auto curable = supervision.cause()) {
      findings_.note(kController, curable->sentence + "; acknowledging resets it");
    }
    if (status.state == bridge::ControllerState::booting ||
        status.state == bridge::ControllerState::busy) {
      findings_.note(kController, std::string("it is ") + bridge::to_string(status.state) +
                                      ": a job waits until it is idle");
    }
    if (const auto complaint = temperature_complaint(job_.limits, status.block_temperature_c)) {
      findings_.note(kController, *complaint + ": a job waits for it");
    }
  }

  void ask_lines() {
    try {
      lines_ = parts_.make_lines();
    } catch (const bridge::DeviceError&) {
      const bool gpiod = configuration_.lines.backend == LinesConfiguration::Backend::gpiod;
      const Complaints complaints =
          gpiod ? gpio_complaints(configuration_.lines.gpiod, *bridge::make_gpio_chips())
                : Complaints{};
      if (complaints.empty()) throw;
      findings_.wrong(kLines, complaints);
      return;
    }
    lines_->read_inputs();
    parts_.wait(kSettle);
    const bridge::SafetyInputs inputs = lines_->read_inputs();
    if (!inputs.failure.empty()) {
      findings_.wrong(kLines, Supervision::line_cause(inputs)->sentence);
      return;
    }
    for (const bridge::SafetyInputs& alone :
         {bridge::SafetyInputs{.estop_pressed = inputs.estop_pressed, .door_open = false},
          bridge::SafetyInputs{.estop_pressed = false, .door_open = inputs.door_open}}) {
      if (const auto cause = Supervision::line_cause(alone)) {
        findings_.wrong(kLines, cause->sentence);
      }
    }
    is_safe_ = !inputs.estop_pressed && !inputs.door_open;
    if (is_safe_) findings_.good(kLines, "the e-stop is released, the door is closed");
    compare("e-stop", inputs.estop_pressed, &bridge::Interlocks::estop_pressed);
    compare("door", inputs.door_open, &bridge::Interlocks::door_open);
  }

  /// Both see the same switch; one that is wired the wrong way round shows here.
  void compare(const char* what, bool by_line, bool bridge::Interlocks::*by_controller) {
    if (!rig_.controller || rig_.controller->interlocks.*by_controller == by_line) return;
    findings_.wrong(kLines, std::string("line and controller disagree about the ") + what +
                                ": look at its contacts, and at active_low");
  }

  void ask_camera() {
    const std::shared_ptr<bridge::Camera> camera = parts_.make_camera();
    camera->apply(job_.camera.settings);
    rig_.camera = camera->describe();
    findings_.good(kCamera, camera_text(*rig_.camera));
    findings_.wrong(kCamera, camera_complaints(job_, *rig_.camera));

    CorrectedCamera corrected(*camera, job_.calibration);
    const bool is_corrected = attempt(kCalibration, [&] {
      corrected.apply(job_.camera.settings);
      rig_.camera = corrected.describe();
      const std::string& correction = rig_.camera->correction;
      if (correction.empty()) {
        findings_.note(kCalibration,
                       "frames are not corrected: calibration.flat and calibration.dark are false");
      } else {
        findings_.good(kCalibration, "frames are corrected by " + correction);
      }
    });
    take_trial_frame(is_corrected ? corrected : *camera);
  }

  static std::string camera_text(const bridge::CameraDescription& camera) {
    std::string text = camera.model + ", " + std::to_string(camera.width) + " × " +
                       std::to_string(camera.height) + " pixels";
    if (camera.lens) {
      text += ", a lens from " + number_text(camera.lens->farthest) + " to " +
              number_text(camera.lens->nearest) + " dioptres";
    }
    return text;
  }

  void take_trial_frame(bridge::Camera& camera) {
    const bool lit = switch_lamp_on();
    bridge::Frame frame;
    const bool taken =
        attempt(kCamera, [&] { frame = capture(camera, job_.camera.capture_time_out); });
    if (lit) attempt(kLines, [&] { lines_->set(bridge::OutputRole::lamp, false); });
    if (!taken) return;

    const double full_scale = frame.image.depth() == CV_16U ? 65535.0 : 255.0;
    const cv::Scalar mean = cv::mean(frame.image);
    const double brightness = (mean[0] + mean[1] + mean[2]) / 3.0 / full_scale;
    findings_.good(kCamera, "trial frame " + std::to_string(frame.sequence) + ", the lamp " +
                                (lit ? "on" : "off") + ": " + exposure_text(frame) +
                                ", mean brightness " + fraction_text(brightness) +
                                " of full scale");
    findings_.wrong(kCamera, frame_complaints(job_, *rig_.camera, frame));
    if (lit) judge_brightness(brightness);
  }

  /// What is in view before the first pass may be anything: no reason not to begin.
  void judge_brightness(double brightness) {
    const QualityThresholds& limits = job_.thresholds;
    if (brightness >= limits.minimum_brightness && brightness <= limits.maximum_brightness) return;
    findings_.note(kCamera, std::string("a face as ") +
                                (brightness < limits.minimum_brightness ? "dark" : "bright") +
                                " as this frame would be rejected (quality.minimum_brightness " +
                                number_text(limits.minimum_brightness) + ", maximum_brightness " +
                                number_text(limits.maximum_brightness) +
                                "): look at lamp, camera.exposure_us and gain");
  }

  /// False when it stays off: without safe lines somebody may look into the chamber.
  bool switch_lamp_on() {
    if (!lines_ || !is_safe_) return false;
    const bool lit = attempt(kLines, [&] { lines_->set(bridge::OutputRole::lamp, true); });
    if (lit) parts_.wait(job_.plan.lamp_warm_up);
    return lit;
  }

  const Configuration& configuration_;
  const JobSettings& job_;
  const RigCheckParts& parts_;
  RigFindings& findings_;
  AnsweredRig rig_;
  std::shared_ptr<bridge::Lines> lines_;
  bool is_safe_ = false;
};

}  // namespace

AnsweredRig check_devices(const Configuration& configuration, const RigCheckParts& parts,
                          RigFindings& findings) {
  return DeviceCheck(configuration, parts, findings).run();
}

}  // namespace biotomy::acquisition
