#include "acquisition/calibration/frame_calibration.hpp"

#include <sstream>
#include <utility>

#include "acquisition/calibration/calibration_record.hpp"
#include "acquisition/calibration/fitness.hpp"
#include "acquisition/calibration/white_balance.hpp"
#include "acquisition/rig/capture.hpp"

namespace biotomy::acquisition {
namespace {

void refuse(CalibrationKind kind, const std::optional<std::string>& complaint) {
  if (!complaint) return;
  throw CalibrationError(std::string("the frames are not fit for a ") + to_string(kind) +
                         (kind == CalibrationKind::white ? " balance: " : " field: ") + *complaint);
}

std::string record_field(FieldKind kind, const CalibrationPlan& plan, const MeanFrame& frames,
                         const bridge::CameraSettings& settings, const std::string& taken_at) {
  const std::string sha256 = write_calibration_frame(plan.folder, kind,
                                                     {.mean = frames.mean(),
                                                      .bits = frames.bits(),
                                                      .frames = frames.count(),
                                                      .settings = settings,
                                                      .taken_at = taken_at,
                                                      .sha256 = ""});
  return std::string(to_string(kind)) + " field " + short_hash(sha256) + " of " +
         std::to_string(frames.count()) + " frames is in " + plan.folder.string() +
         ((kind == FieldKind::flat ? plan.flat : plan.dark)
              ? ", in force from the next start of a job on"
              : std::string("; set calibration.") + to_string(kind) + " = true to correct by it");
}

std::string record_white(const CalibrationPlan& plan, const MeanFrame& frames,
                         const bridge::CameraSettings& settings, const std::string& taken_at) {
  const WhiteBalance balance = white_balance(frames, {settings.red_gain, settings.blue_gain});
  write_white_balance(plan.folder, balance, settings, taken_at);
  std::ostringstream text;
  text.precision(4);
  text << "for a neutral grey set camera.red_gain = " << balance.red_gain
       << " and camera.blue_gain = " << balance.blue_gain << ", instead of " << settings.red_gain
       << " and " << settings.blue_gain;
  return text.str();
}

}  // namespace

const char* to_string(CalibrationKind kind) {
  switch (kind) {
    case CalibrationKind::flat:
      return "flat";
    case CalibrationKind::dark:
      return "dark";
    case CalibrationKind::white:
      return "white";
  }
  return "?";
}

FrameCalibration::FrameCalibration(CalibrationKind kind, const CalibrationPlan& plan,
                                   const CameraPlan& camera, std::chrono::milliseconds lamp_warm_up,
                                   const FrameCalibrationParts& parts,
                                   std::function<std::string()> utc_now, TimePoint now)
    : kind_(kind),
      plan_(plan),
      camera_(camera),
      lamp_warm_up_(lamp_warm_up),
      parts_(parts),
      utc_now_(std::move(utc_now)),
      begun_(now) {
  parts_.lines.set(bridge::OutputRole::lamp, kind != CalibrationKind::dark);
}

std::string FrameCalibration::progress() const {
  return std::to_string(taken_) + " of " + std::to_string(plan_.frames) + " frames are taken";
}

/// The rig is not looked at: nothing of it moves.
std::optional<std::string> FrameCalibration::poll(const std::optional<bridge::StageStatus>&,
                                                  TimePoint now) {
  if (record_.valid()) {
    return is_ready(record_) ? std::optional(record_.get()) : std::nullopt;
  }
  if (now - begun_ < lamp_warm_up_) return std::nullopt;
  if (frame_.valid()) {
    if (!is_ready(frame_)) return std::nullopt;
    frame_.get();
    ++taken_;
  }
  if (taken_ < plan_.frames) {
    ask_frame();
  } else {
    ask_record();
  }
  return std::nullopt;
}

void FrameCalibration::ask_frame() {
  frame_ = run_on(parts_.worker, [camera = &parts_.camera, settings = camera_.settings,
                                  time_out = camera_.capture_time_out, frames = frames_] {
    if (frames->count() == 0) {
      *frames = MeanFrame(camera->describe().transfer);
      camera->apply(settings);
    }
    frames->add(capture(*camera, time_out).image);
  });
}

void FrameCalibration::ask_record() {
  record_ = run_on(parts_.worker, [kind = kind_, plan = plan_, settings = camera_.settings,
                                   frames = frames_, taken_at = utc_now_()] {
    switch (kind) {
      case CalibrationKind::flat:
        refuse(kind, flat_complaint(*frames));
        return record_field(FieldKind::flat, plan, *frames, settings, taken_at);
      case CalibrationKind::dark:
        refuse(kind, dark_complaint(*frames));
        return record_field(FieldKind::dark, plan, *frames, settings, taken_at);
      case CalibrationKind::white:
        break;
    }
    refuse(kind, white_complaint(*frames));
    return record_white(plan, *frames, settings, taken_at);
  });
}

}  // namespace biotomy::acquisition
