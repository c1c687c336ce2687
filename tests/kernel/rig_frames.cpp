#include <chrono>
#include <stdexcept>
#include <variant>

#include <opencv2/core/mat.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "firmware_bridge/wire/rig_client.hpp"
#include "firmware_bridge/wire/shared_frame.hpp"
#include "tests/kernel/frame_source.hpp"

namespace biotomy::tests {

namespace {

constexpr std::chrono::seconds kPatience(20);
constexpr int kJpegQuality = 95;

class RigFrames final : public FrameSource {
 public:
  explicit RigFrames(const std::filesystem::path& socket)
      : camera_(socket, bridge::RigService::camera) {}

  std::vector<std::uint8_t> next(const FrameSize&) override {
    const bridge::RigAnswer answer = camera_.ask(bridge::CaptureMessage{}, kPatience);
    const auto* frame = std::get_if<bridge::FrameMessage>(&answer.message);
    if (frame == nullptr || frame->format != bridge::RigPixelFormat::rgb888) {
      throw std::runtime_error("the rig's camera gives no RGB888");
    }
    const auto stride = static_cast<std::size_t>(frame->stride);
    const bridge::MappedFrame mapped(answer.descriptor,
                                     stride * static_cast<std::size_t>(frame->height));
    const cv::Mat rgb(frame->height, frame->width, CV_8UC3,
                      const_cast<std::byte*>(mapped.bytes().data()), stride);
    cv::Mat bgr;
    cv::cvtColor(rgb, bgr, cv::COLOR_RGB2BGR);
    std::vector<std::uint8_t> jpeg;
    cv::imencode(".jpg", bgr, jpeg, {cv::IMWRITE_JPEG_QUALITY, kJpegQuality});
    return jpeg;
  }

 private:
  bridge::RigClient camera_;
};

}  // namespace

std::unique_ptr<FrameSource> frames_of_rig(const std::filesystem::path& socket) {
  return std::make_unique<RigFrames>(socket);
}

}  // namespace biotomy::tests
