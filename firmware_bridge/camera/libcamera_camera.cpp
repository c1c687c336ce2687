#include "firmware_bridge/camera/libcamera_camera.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <condition_variable>
#include <deque>
#include <mutex>
#include <optional>
#include <system_error>
#include <utility>

#include <libcamera/camera_manager.h>
#include <libcamera/control_ids.h>
#include <libcamera/property_ids.h>
#include <libcamera/request.h>
#include <libcamera/stream.h>

#include "firmware_bridge/camera/libcamera_buffers.hpp"
#include "firmware_bridge/camera/libcamera_format.hpp"
#include "firmware_bridge/camera/libcamera_manager.hpp"
#include "firmware_bridge/device_error.hpp"

namespace biotomy::bridge {

namespace {

using Kind = DeviceError::Kind;
using Clock = std::chrono::steady_clock;

/// Sensors take a frame or two to obey new settings; these are dropped after each start.
constexpr int kSettlingFrames = 2;

/// And a lens on its way takes some more.
constexpr int kLensFrames = 4;

std::string model_of(const libcamera::Camera& camera) {
  return camera.properties().get(libcamera::properties::Model).value_or(camera.id());
}

std::shared_ptr<libcamera::Camera> find_camera(const libcamera::CameraManager& manager,
                                               const std::string& wanted) {
  const auto cameras = manager.cameras();
  if (cameras.empty()) {
    throw DeviceError(Kind::configuration,
                      "camera: libcamera finds none on this computer; is it connected, and may "
                      "this user open /dev/video* and /dev/media*?");
  }
  std::string names;
  for (const auto& camera : cameras) {
    if (wanted.empty() || camera->id() == wanted || model_of(*camera) == wanted) return camera;
    names += (names.empty() ? "" : ", ") + model_of(*camera) + " (" + camera->id() + ")";
  }
  throw DeviceError(
      Kind::configuration,
      "camera \"" + wanted + "\": there is none of that id or model; there is " + names);
}

/// The requests that came back, from libcamera's thread to ours. Its lock is never held while
/// libcamera is called.
class CompletedRequests {
 public:
  void push(libcamera::Request* request) {
    const std::lock_guard lock(mutex_);
    requests_.push_back(request);
    arrived_.notify_one();
  }

  void wake() {
    const std::lock_guard lock(mutex_);
    is_gone_ = true;
    arrived_.notify_one();
  }

  bool is_gone() {
    const std::lock_guard lock(mutex_);
    return is_gone_;
  }

  void clear() {
    const std::lock_guard lock(mutex_);
    requests_.clear();
  }

  /// The next, or none if there was none by `deadline` or the camera is gone.
  libcamera::Request* pop(Clock::time_point deadline) {
    std::unique_lock lock(mutex_);
    arrived_.wait_until(lock, deadline, [&] { return !requests_.empty() || is_gone_; });
    if (requests_.empty()) return nullptr;
    libcamera::Request* request = requests_.front();
    requests_.pop_front();
    return request;
  }

 private:
  std::mutex mutex_;
  std::condition_variable arrived_;
  std::deque<libcamera::Request*> requests_;
  bool is_gone_ = false;
};

}  // namespace

/// An acquired, configured camera with its buffers.
class LibcameraCamera::Session {
 public:
  explicit Session(const LibcameraSettings& settings);
  ~Session();
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;

  CameraDescription describe() const;
  void apply(const CameraSettings& settings);
  Frame capture(std::chrono::milliseconds time_out);

 private:
  /// Streams as long as it lives.
  class Streaming;

  void write_controls(libcamera::ControlList& controls) const;
  std::optional<LensRange> lens_range() const;
  void check_lens(double dioptres) const;
  bool has_control(unsigned int id) const { return camera_->controls().count(id) > 0; }
  [[noreturn]] void fail(Kind kind, const std::string& what) const;
  void check(int result, const char* what) const;
  void queue(libcamera::Request& request);
  Frame frame_of(libcamera::Request& request);

  std::shared_ptr<libcamera::CameraManager> manager_;
  std::shared_ptr<libcamera::Camera> camera_;
  std::unique_ptr<libcamera::CameraConfiguration> configuration_;
  std::unique_ptr<LibcameraBuffers> buffers_;
  std::vector<std::unique_ptr<libcamera::Request>> requests_;
  std::optional<CameraSettings> settings_;
  std::optional<double> lens_at_;  ///< where it was driven for the last capture
  CompletedRequests completed_;
};

class LibcameraCamera::Session::Streaming {
 public:
  explicit Streaming(Session& session) : session_(session) {
    libcamera::ControlList controls(session.camera_->controls());
    session.write_controls(controls);
    session.check(session.camera_->start(&controls), "it does not start");
    try {
      for (const auto& request : session.requests_) {
        request->reuse(libcamera::Request::ReuseBuffers);
        session.queue(*request);
      }
    } catch (...) {
      session.camera_->stop();
      throw;
    }
  }
  ~Streaming() {
    // Blocks until the requests under way have come back, cancelled, on libcamera's thread.
    session_.camera_->stop();
    session_.completed_.clear();
  }
  Streaming(const Streaming&) = delete;
  Streaming& operator=(const Streaming&) = delete;

 private:
  Session& session_;
};

LibcameraCamera::Session::Session(const LibcameraSettings& settings)
    : manager_(shared_camera_manager()), camera_(find_camera(*manager_, settings.camera)) {
  check(camera_->acquire(), "it is in use by another program");
  try {
    configuration_ = choose_configuration(*camera_, settings);
    check(camera_->configure(configuration_.get()), "it refuses its configuration");
    libcamera::Stream* stream = configuration_->at(0).stream();
    buffers_ = std::make_unique<LibcameraBuffers>(camera_, stream);
    for (const auto& buffer : buffers_->all()) {
      std::unique_ptr<libcamera::Request> request = camera_->createRequest();
      if (!request) fail(Kind::configuration, "it makes no requests");
      check(request->addBuffer(stream, buffer.get()), "it does not take its own buffer");
      requests_.push_back(std::move(request));
    }
  } catch (...) {
    requests_.clear();
    buffers_.reset();
    camera_->release();
    throw;
  }
  camera_->requestCompleted.connect(&completed_, &CompletedRequests::push);
  camera_->disconnected.connect(&completed_, &CompletedRequests::wake);
}

LibcameraCamera::Session::~Session() {
  camera_->requestCompleted.disconnect(&completed_);
  camera_->disconnected.disconnect(&completed_);
  requests_.clear();
  buffers_.reset();
  configuration_.reset();
  camera_->release();
}

void LibcameraCamera::Session::fail(Kind kind, const std::string& what) const {
  throw DeviceError(kind, "camera " + camera_->id() + ": " + what);
}

void LibcameraCamera::Session::check(int result, const char* what) const {
  if (result >= 0) return;
  const Kind kind = result == -ENODEV ? Kind::disconnected : Kind::configuration;
  fail(kind, std::string(what) + ": " + std::generic_category().message(-result));
}

CameraDescription LibcameraCamera::Session::describe() const {
  const libcamera::Size size = configuration_->at(0).size;
  return {.model = model_of(*camera_),
          .width = static_cast<int>(size.width),
          .height = static_cast<int>(size.height),
          .lens = lens_range()};
}

std::optional<LensRange> LibcameraCamera::Session::lens_range() const {
  const auto lens = camera_->controls().find(libcamera::controls::LENS_POSITION);
  if (lens == camera_->controls().end()) return std::nullopt;
  return LensRange{.farthest = static_cast<double>(lens->second.min().get<float>()),
                   .nearest = static_cast<double>(lens->second.max().get<float>())};
}

void LibcameraCamera::Session::check_lens(double dioptres) const {
  const std::optional<LensRange> lens = lens_range();
  if (!lens) fail(Kind::refused, "it has no lens that can be driven");
  if (dioptres < lens->farthest || dioptres > lens->nearest) {
    fail(Kind::refused, "a lens position of " + std::to_string(dioptres) + " dioptres; it can do " +
                            std::to_string(lens->farthest) + " to " +
                            std::to_string(lens->nearest));
  }
}

void LibcameraCamera::Session::apply(const CameraSettings& settings) {
  const auto exposures = camera_->controls().find(libcamera::controls::EXPOSURE_TIME);
  if (exposures != camera_->controls().end()) {
    const auto least = exposures->second.min().get<std::int32_t>();
    const auto most = exposures->second.max().get<std::int32_t>();
    if (settings.exposure.count() < least || settings.exposure.count() > most) {
      fail(Kind::refused, "an exposure of " + std::to_string(settings.exposure.count()) +
                              " us; it can do " + std::to_string(least) + " to " +
                              std::to_string(most));
    }
  }
  if (settings.lens_position) check_lens(*settings.lens_position);
  settings_ = settings;
}

void LibcameraCamera::Session::write_controls(libcamera::ControlList& controls) const {
  if (!settings_) return;
  namespace id = libcamera::controls;
  if (has_control(id::AE_ENABLE)) controls.set(id::AeEnable, false);
  if (has_control(id::AWB_ENABLE)) controls.set(id::AwbEnable, false);
  if (has_control(id::EXPOSURE_TIME)) {
    controls.set(id::ExposureTime, static_cast<std::int32_t>(settings_->exposure.count()));
  }
  if (has_control(id::ANALOGUE_GAIN)) {
    controls.set(id::AnalogueGain, static_cast<float>(settings_->gain));
  }
  if (has_control(id::COLOUR_GAINS)) {
    const std::array gains{static_cast<float>(settings_->red_gain),
                           static_cast<float>(settings_->blue_gain)};
    controls.set(id::ColourGains, libcamera::Span<const float, 2>(gains));
  }
  if (settings_->lens_position) {
    if (has_control(id::AF_MODE)) controls.set(id::AfMode, id::AfModeManual);
    controls.set(id::LensPosition, static_cast<float>(*settings_->lens_position));
  }
}

void LibcameraCamera::Session::queue(libcamera::Request& request) {
  // Some pipelines obey the controls given at the start, some those of each request.
  write_controls(request.controls());
  check(camera_->queueRequest(&request), "it takes no requests");
}

Frame LibcameraCamera::Session::capture(std::chrono::milliseconds time_out) {
  const Clock::time_point deadline = Clock::now() + time_out;
  if (completed_.is_gone()) fail(Kind::disconnected, "it was unplugged; restart when it is back");
  const Streaming streaming(*this);

  int to_drop = kSettlingFrames;
  const std::optional<double> lens = settings_ ? settings_->lens_position : std::nullopt;
  if (std::exchange(lens_at_, lens) != lens) to_drop += kLensFrames;
  while (libcamera::Request* request = completed_.pop(deadline)) {
    const bool is_complete = request->status() == libcamera::Request::RequestComplete;
    const libcamera::FrameBuffer& buffer = *request->buffers().begin()->second;
    // Another status is a torn or lost frame, or one of a sensor that is starting up.
    const bool is_good =
        is_complete && buffer.metadata().status == libcamera::FrameMetadata::FrameSuccess;
    if (is_good && to_drop-- <= 0) return frame_of(*request);
    if (is_complete) {
      request->reuse(libcamera::Request::ReuseBuffers);
      queue(*request);
    }
  }
  if (completed_.is_gone()) fail(Kind::disconnected, "it was unplugged");
  fail(Kind::timeout, "no good frame within " + std::to_string(time_out.count()) + " ms");
}

Frame LibcameraCamera::Session::frame_of(libcamera::Request& request) {
  const libcamera::FrameBuffer& buffer = *request.buffers().begin()->second;
  const libcamera::StreamConfiguration& stream = configuration_->at(0);
  const libcamera::ControlList& metadata = request.metadata();
  namespace id = libcamera::controls;
  Frame frame;
  try {
    frame.image = buffers_->to_image(buffer, *known_format(stream.pixelFormat), range_of(stream));
  } catch (const PixelError& error) {
    fail(Kind::refused, error.what());
  }
  frame.sequence = buffer.metadata().sequence;
  const std::int64_t timestamp =
      metadata.get(id::SensorTimestamp)
          .value_or(static_cast<std::int64_t>(buffer.metadata().timestamp));
  frame.sensor_timestamp = std::chrono::nanoseconds(timestamp);
  // What the camera doesn't tell stays 0: better unknown than the wish for the fact.
  frame.exposure = std::chrono::microseconds(metadata.get(id::ExposureTime).value_or(0));
  frame.gain = static_cast<double>(metadata.get(id::AnalogueGain).value_or(0.0F));
  return frame;
}

std::vector<ListedCamera> list_libcamera_cameras() {
  const auto manager = shared_camera_manager();
  std::vector<ListedCamera> listed;
  for (const auto& camera : manager->cameras()) {
    listed.push_back({.id = camera->id(), .model = model_of(*camera)});
  }
  return listed;
}

LibcameraCamera::LibcameraCamera(const LibcameraSettings& settings)
    : session_(std::make_unique<Session>(settings)) {}

LibcameraCamera::~LibcameraCamera() = default;

CameraDescription LibcameraCamera::describe() {
  return session_->describe();
}
void LibcameraCamera::apply(const CameraSettings& settings) {
  session_->apply(settings);
}
Frame LibcameraCamera::capture(std::chrono::milliseconds time_out) {
  return session_->capture(time_out);
}

}  // namespace biotomy::bridge
