#include "sim/service/camera_service.hpp"

#include <algorithm>
#include <span>
#include <utility>

#include <opencv2/imgproc.hpp>

#include "firmware_bridge/wire/shared_frame.hpp"

namespace biotomy::sim {

namespace {

void check(const char* what, double value, double least, double most) {
  if (value < least || value > most) {
    throw bridge::RigRefusal(std::string(what) + " " + std::to_string(value) + " is not between " +
                             std::to_string(least) + " and " + std::to_string(most));
  }
}

/// The photograph in sealed memory, its rows without gaps.
bridge::UniqueFd shared(const cv::Mat& image) {
  const std::size_t row_bytes = image.elemSize() * static_cast<std::size_t>(image.cols);
  bridge::FrameMemory memory(row_bytes * static_cast<std::size_t>(image.rows));
  for (int y = 0; y < image.rows; ++y) {
    const std::span<const std::byte> row(reinterpret_cast<const std::byte*>(image.ptr(y)),
                                         row_bytes);
    std::ranges::copy(row, memory.bytes().begin() + static_cast<std::ptrdiff_t>(
                                                        row_bytes * static_cast<std::size_t>(y)));
  }
  return memory.seal();
}

}  // namespace

CameraService::CameraService(std::string model, Camera camera, const CameraOptics& optics, Rig& rig,
                             WitnessLog& witness, CameraTime time)
    : model_(std::move(model)),
      optics_(optics),
      rig_(rig),
      witness_(witness),
      time_(std::move(time)),
      camera_(std::move(camera)) {}

std::optional<bridge::WelcomeMessage> CameraService::welcome() {
  if (!rig_.camera_condition().answers()) {
    rig_.note_camera_failure();
    return std::nullopt;
  }
  bridge::WelcomeMessage message;
  message.camera = {model_, optics_.view.width, optics_.view.height, bridge::Transfer::linear};
  return message;
}

std::optional<bridge::RigAnswer> CameraService::answer(const bridge::RigMessage& request) {
  const std::lock_guard lock(using_);
  if (std::holds_alternative<bridge::CaptureMessage>(request)) {
    return capture();
  }
  if (!rig_.camera_condition().answers()) {
    rig_.note_camera_failure();
    return std::nullopt;
  }
  if (const auto* settings = std::get_if<bridge::ConfigureMessage>(&request)) {
    configure(*settings);
    return bridge::RigAnswer{bridge::ConfiguredMessage{}, {}};
  }
  throw bridge::RigRefusal("the camera does not know " + bridge::type_of(request));
}

void CameraService::configure(const bridge::ConfigureMessage& request) {
  check("exposure_us", request.exposure_us, 10, 10e6);
  check("gain", request.gain, 1, 16);
  check("red_gain", request.red_gain, 0.1, 8);
  check("blue_gain", request.blue_gain, 0.1, 8);
  exposure_ = {request.exposure_us, request.gain, request.red_gain, request.blue_gain};
}

/// What a camera in this condition gives in place of the image.
cv::Mat CameraService::spoilt(const cv::Mat& image, const CameraCondition& condition) const {
  cv::Mat given = image.clone();
  if (condition.gives_old_frame && !last_.empty()) {
    last_.copyTo(given);
  }
  if (condition.torn_at && !last_.empty()) {
    const cv::Range old(static_cast<int>(*condition.torn_at * image.rows), image.rows);
    last_.rowRange(old).copyTo(given.rowRange(old));
  }
  if (condition.gives_black_frame) {
    given.setTo(cv::Scalar::all(0));
  }
  if (condition.wrong_size) {
    cv::resize(given, given, {condition.wrong_size->width, condition.wrong_size->height}, 0, 0,
               cv::INTER_AREA);
  }
  return given;
}

std::optional<bridge::RigAnswer> CameraService::capture() {
  std::optional<bridge::RigAnswer> answer;
  const CameraCondition condition = rig_.begin_capture();
  if (condition.answers()) {
    answer = photograph(condition);
    if (!rig_.camera_condition().answers()) {
      answer.reset();
    }
  }
  rig_.end_capture();
  return answer;
}

bridge::RigAnswer CameraService::photograph(const CameraCondition& condition) {
  const auto began = time_.now();
  const Scene begin = rig_.scene();
  time_.wait(std::chrono::microseconds(
      static_cast<std::int64_t>(exposure_.exposure_us / rig_.time_scale())));
  const Scene end = rig_.scene();
  const double rig_s = rig_.rig_seconds();
  const Photograph photograph = camera_.take(begin, end, exposure_);
  witness_.capture(rig_s, {.number = photograph.number,
                           .face_um = end.block.mean_um(),
                           .column_um = end.column_scale_um,
                           .defocus_um = photograph.defocus_um,
                           .blur_sigma_um = blur_sigma_um(optics_.lens, photograph.defocus_um),
                           .face_in_view = photograph.face_in_view,
                           .lamp_on = begin.lamp_on && end.lamp_on,
                           .specks = end.block.debris().size(),
                           .lamp_share = end.lamp_share,
                           .vibration_mm_s = end.vibration_mm_s,
                           .spoilt = condition.spoils_frames()});
  cv::Mat image = photograph.image;
  if (condition.spoils_frames()) {
    image = spoilt(image, condition);
  } else {
    last_ = image;
    last_number_ = photograph.number;
    last_taken_ = began;
  }
  const bool old_number = condition.gives_old_number && !last_.empty();
  bridge::FrameMessage frame;
  frame.width = image.cols;
  frame.height = image.rows;
  frame.stride = static_cast<int>(image.elemSize()) * image.cols;
  frame.format =
      image.depth() == CV_16U ? bridge::RigPixelFormat::rgb161616 : bridge::RigPixelFormat::rgb888;
  frame.sequence = old_number ? last_number_ : photograph.number;
  frame.timestamp_ns =
      std::chrono::nanoseconds((old_number ? last_taken_ : began).time_since_epoch()).count();
  frame.exposure_us = exposure_.exposure_us;
  frame.gain = exposure_.gain;
  return {frame, shared(image)};
}

}  // namespace biotomy::sim
