#include "firmware_bridge/camera/libcamera_session.hpp"

#include <algorithm>
#include <cerrno>
#include <ctime>
#include <system_error>
#include <utility>

#include <libcamera/control_ids.h>
#include <libcamera/request.h>
#include <libcamera/stream.h>

#include "firmware_bridge/camera/libcamera_controls.hpp"
#include "firmware_bridge/camera/libcamera_format.hpp"
#include "firmware_bridge/camera/libcamera_manager.hpp"

namespace biotomy::bridge {

namespace {

using Kind = DeviceError::Kind;
using std::chrono::nanoseconds;

constexpr std::size_t kStill = 0;
constexpr std::size_t kViewfinder = 1;

/// A timestamp further back than this is of another clock.
constexpr nanoseconds kOldest = std::chrono::seconds(60);

std::shared_ptr<libcamera::Camera> find_camera(const libcamera::CameraManager& manager,
                                               const std::string& wanted, Kind if_missing) {
  const auto cameras = manager.cameras();
  if (cameras.empty()) {
    throw DeviceError(if_missing,
                      "camera: libcamera finds none on this computer; is it connected, and may "
                      "this user open /dev/video* and /dev/media*?");
  }
  std::string names;
  std::vector<std::shared_ptr<libcamera::Camera>> of_model;
  for (const auto& camera : cameras) {
    if (wanted.empty() || camera->id() == wanted) return camera;
    if (model_of(*camera) == wanted) of_model.push_back(camera);
    names += (names.empty() ? "" : ", ") + model_of(*camera) + " (" + camera->id() + ")";
  }
  if (of_model.size() > 1) {
    throw DeviceError(Kind::configuration, "camera \"" + wanted +
                                               "\": there are several of that model; name one by "
                                               "its id: " +
                                               names);
  }
  if (of_model.empty()) {
    throw DeviceError(if_missing, "camera \"" + wanted +
                                      "\": there is none of that id or model; there is " + names);
  }
  return of_model.front();
}

nanoseconds time_of(clockid_t clock) {
  timespec now{};
  ::clock_gettime(clock, &now);
  return std::chrono::seconds(now.tv_sec) + nanoseconds(now.tv_nsec);
}

/// A pipeline that fills in nothing (the virtual one of libcamera 0.4) leaves status, sequence and
/// time as the memory was; the numbers of bytes alone are then 0 for certain.
bool is_filled_in(const libcamera::FrameMetadata& metadata) {
  const auto& planes = metadata.planes();
  return std::any_of(planes.begin(), planes.end(),
                     [](const auto& plane) { return plane.bytesused > 0; });
}

/// Torn or lost, or of a sensor that is starting up.
bool is_spoilt(const libcamera::FrameMetadata& metadata) {
  using libcamera::FrameMetadata;
  if (is_filled_in(metadata)) return metadata.status != FrameMetadata::FrameSuccess;
  return metadata.status == FrameMetadata::FrameError ||
         metadata.status == FrameMetadata::FrameCancelled;
}

/// The sensor's time of the frame; 0 if it is not known.
nanoseconds stamp_of(libcamera::Request& request) {
  const auto told = request.metadata().get(libcamera::controls::SensorTimestamp);
  if (told && *told > 0) return nanoseconds(*told);
  const libcamera::FrameMetadata& metadata = request.buffers().begin()->second->metadata();
  return nanoseconds(is_filled_in(metadata) ? metadata.timestamp : 0);
}

/// A frame's time on CLOCK_MONOTONIC; 0 if it is not known. libcamera means CLOCK_BOOTTIME, which
/// differs once the computer was suspended, and the kernel's drivers stamp by CLOCK_MONOTONIC.
nanoseconds monotonic(nanoseconds stamp) {
  if (stamp == nanoseconds(0)) return stamp;
  const nanoseconds now = time_of(CLOCK_MONOTONIC);
  for (const nanoseconds shift : {nanoseconds(0), now - time_of(CLOCK_BOOTTIME)}) {
    const nanoseconds shifted = stamp + shift;
    if (shifted <= now && now - shifted < kOldest) return shifted;
  }
  return nanoseconds(0);
}

/// Ends a capture's use of the line, however it ends.
class SyncedCapture {
 public:
  explicit SyncedCapture(CameraSync& sync) : sync_(sync) { sync_.begin_capture(); }
  ~SyncedCapture() { sync_.end_capture(); }
  SyncedCapture(const SyncedCapture&) = delete;
  SyncedCapture& operator=(const SyncedCapture&) = delete;

 private:
  CameraSync& sync_;
};

}  // namespace

LibcameraSession::LibcameraSession(const LibcameraSettings& settings, CameraSync& sync,
                                   Kind if_missing)
    : manager_(shared_camera_manager()),
      camera_(find_camera(*manager_, settings.camera, if_missing)),
      sync_(sync),
      raw_is_srgb_(settings.raw_is_srgb),
      gate_(settings_offered(camera_->controls()), sync.is_trigger()) {
  check(camera_->acquire(), "it is in use by another program");
  try {
    configuration_ = choose_configuration(*camera_, settings);
    check(camera_->configure(configuration_.get()), "it refuses its configuration");
    for (libcamera::StreamConfiguration& stream : *configuration_) {
      buffers_.push_back(std::make_unique<LibcameraBuffers>(camera_, stream.stream()));
    }
    make_requests();
  } catch (...) {
    requests_.clear();
    buffers_.clear();
    camera_->release();
    throw;
  }
  camera_->requestCompleted.connect(&completed_, &CompletedRequests::push);
  camera_->disconnected.connect(&completed_, &CompletedRequests::go);
}

LibcameraSession::~LibcameraSession() {
  // Blocks until the requests under way have come back, cancelled, on libcamera's thread.
  if (is_streaming_) camera_->stop();
  camera_->requestCompleted.disconnect(&completed_);
  camera_->disconnected.disconnect(&completed_);
  requests_.clear();
  buffers_.clear();
  configuration_.reset();
  camera_->release();
}

void LibcameraSession::make_requests() {
  std::size_t count = buffers_.front()->all().size();
  for (const auto& buffers : buffers_) count = std::min(count, buffers->all().size());
  for (std::size_t i = 0; i < count; ++i) {
    std::unique_ptr<libcamera::Request> request = camera_->createRequest();
    if (!request) fail(Kind::configuration, "it makes no requests");
    for (std::size_t stream = 0; stream < buffers_.size(); ++stream) {
      const auto index = static_cast<unsigned int>(stream);
      check(
          request->addBuffer(configuration_->at(index).stream(), buffers_[stream]->all()[i].get()),
          "it does not take its own buffer");
    }
    parked_.push_back(request.get());
    requests_.push_back(std::move(request));
  }
}

void LibcameraSession::fail(Kind kind, const std::string& what) const {
  throw DeviceError(kind, "camera " + camera_->id() + ": " + what);
}

void LibcameraSession::check(int result, const char* what) const {
  if (result >= 0) return;
  const Kind kind = result == -ENODEV ? Kind::disconnected : Kind::configuration;
  fail(kind, std::string(what) + ": " + std::generic_category().message(-result));
}

CameraDescription LibcameraSession::describe() const {
  const libcamera::Size size = configuration_->at(kStill).size;
  return {.model = model_of(*camera_),
          .width = static_cast<int>(size.width),
          .height = static_cast<int>(size.height),
          .lens = lens_range(camera_->controls()),
          .transfer = transfer_of(configuration_->at(kStill).pixelFormat, raw_is_srgb_)};
}

void LibcameraSession::apply(const CameraSettings& settings) {
  if (const auto complaint = settings_complaint(camera_->controls(), settings)) {
    fail(Kind::refused, *complaint);
  }
  if (settings_ != settings) {
    for (const auto& request : requests_) outdated_.insert(request.get());
  }
  settings_ = settings;
  gate_.ask(settings);
}

void LibcameraSession::start() {
  libcamera::ControlList controls(camera_->controls());
  if (settings_) write_settings(camera_->controls(), *settings_, controls);
  check(camera_->start(&controls), "it does not start");
  is_streaming_ = true;
  gate_.start();
}

void LibcameraSession::queue(libcamera::Request& request) {
  request.reuse(libcamera::Request::ReuseBuffers);
  // Some pipelines obey the controls given at the start, some those of each request.
  if (settings_) write_settings(camera_->controls(), *settings_, request.controls());
  outdated_.erase(&request);
  check(camera_->queueRequest(&request), "it takes no requests");
}

void LibcameraSession::queue_parked() {
  while (!parked_.empty()) {
    queue(*parked_.back());
    parked_.pop_back();
  }
}

/// What arrived since the last capture is old.
void LibcameraSession::park_completed() {
  while (libcamera::Request* request = completed_.pop(Clock::now())) {
    parked_.push_back(request);
  }
}

libcamera::Request& LibcameraSession::next_request(Clock::time_point deadline,
                                                   std::chrono::milliseconds silence,
                                                   const std::string& last_refusal) {
  if (Clock::now() < deadline) {
    libcamera::Request* request = completed_.pop(std::min(deadline, Clock::now() + silence));
    if (request != nullptr) return *request;
    if (completed_.is_gone()) fail(Kind::disconnected, "it was unplugged");
    if (Clock::now() < deadline) throw CameraStalled("it delivers nothing");
  }
  if (last_refusal.empty()) fail(Kind::timeout, "no frame in time");
  fail(Kind::timeout, "no good frame in time: of the last one, " + last_refusal);
}

std::optional<std::string> LibcameraSession::refusal(libcamera::Request& request) {
  const libcamera::ControlList& metadata = request.metadata();
  DeliveredFrame frame{.timestamp = monotonic(stamp_of(request)),
                       .duration = {},
                       .told = told_settings(metadata),
                       .was_asked_before = outdated_.contains(&request)};
  if (const auto duration = metadata.get(libcamera::controls::FrameDuration)) {
    frame.duration = std::chrono::microseconds(*duration);
  }
  return gate_.refusal(frame);
}

Frame LibcameraSession::capture(Clock::time_point deadline, std::chrono::milliseconds silence) {
  if (completed_.is_gone()) fail(Kind::disconnected, "it was unplugged");
  if (!is_streaming_) start();
  park_completed();
  const SyncedCapture synced(sync_);
  gate_.open(time_of(CLOCK_MONOTONIC));
  std::string last_refusal;
  for (;;) {
    queue_parked();
    sync_.trigger();
    libcamera::Request& request = next_request(deadline, silence, last_refusal);
    parked_.push_back(&request);
    if (request.status() != libcamera::Request::RequestComplete) {
      if (completed_.is_gone()) fail(Kind::disconnected, "it was unplugged");
      throw CameraStalled("its requests were cancelled");
    }
    if (is_spoilt(request.findBuffer(configuration_->at(kStill).stream())->metadata())) {
      last_refusal = "the camera says that it is spoilt";
      continue;
    }
    if (const auto reason = refusal(request)) {
      last_refusal = *reason;
      continue;
    }
    try {
      return frame_of(request);
    } catch (const PixelError& error) {
      last_refusal = std::string("it is ") + error.what();
    }
  }
}

Frame LibcameraSession::frame_of(libcamera::Request& request) const {
  const RawColours raw = raw_colours(request.metadata(), settings_, raw_is_srgb_);
  const auto image_of = [&](std::size_t stream) {
    const auto index = static_cast<unsigned int>(stream);
    const libcamera::FrameBuffer* buffer = request.findBuffer(configuration_->at(index).stream());
    return buffers_[stream]->to_image(*buffer, configuration_->at(index), raw);
  };
  const ToldSettings told = told_settings(request.metadata());
  Frame frame;
  frame.image = image_of(kStill);
  if (buffers_.size() > kViewfinder) frame.viewfinder = image_of(kViewfinder);
  const libcamera::FrameMetadata& still =
      request.findBuffer(configuration_->at(kStill).stream())->metadata();
  frame.sequence = is_filled_in(still) ? still.sequence : request.sequence();
  frame.sensor_timestamp = stamp_of(request);
  // What the camera doesn't tell stays 0: better unknown than the wish for the fact.
  frame.exposure = told.exposure.value_or(std::chrono::microseconds(0));
  frame.gain = told.gain.value_or(0.0);
  return frame;
}

}  // namespace biotomy::bridge
