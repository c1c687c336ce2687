#include "acquisition/records/rejected_frames.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <span>
#include <utility>
#include <vector>

#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "reconstruct/errors.hpp"
#include "reconstruct/store/durable_file.hpp"

namespace biotomy::acquisition {
namespace {

constexpr int kJpegQuality = 85;

cv::Mat small_bgr(const cv::Mat& image, int width_px) {
  cv::Mat small = image;
  const int longest = std::max(image.cols, image.rows);
  if (longest > width_px) {
    const double factor = static_cast<double>(width_px) / longest;
    cv::resize(image, small, {}, factor, factor, cv::INTER_AREA);
  }
  if (small.depth() == CV_16U) {
    cv::Mat bytes;
    small.convertTo(bytes, CV_8U, 1.0 / 257.0);
    small = bytes;
  }
  cv::Mat bgr;
  cv::cvtColor(small, bgr, cv::COLOR_RGB2BGR);
  return bgr;
}

}  // namespace

RejectedFrames::RejectedFrames(std::filesystem::path folder, int kept, int width_px)
    : folder_(std::move(folder)), kept_(kept), width_px_(width_px) {}

std::filesystem::path RejectedFrames::add(std::int64_t layer, int attempt, const std::string& slug,
                                          const cv::Mat& image) const {
  std::array<char, 64> number{};
  std::snprintf(number.data(), number.size(), "%06lld-a%02d-", static_cast<long long>(layer),
                attempt);
  std::filesystem::path path = folder_ / (number.data() + slug + ".jpg");
  std::vector<unsigned char> jpeg;
  if (image.empty() || !cv::imencode(".jpg", small_bgr(image, width_px_), jpeg,
                                     {cv::IMWRITE_JPEG_QUALITY, kJpegQuality})) {
    throw reconstruct::SampleError(path.string() + ": the frame cannot be encoded as JPEG");
  }
  reconstruct::write_durably(path, std::as_bytes(std::span(jpeg)));
  remove_oldest();
  return path;
}

void RejectedFrames::remove_oldest() const {
  std::vector<std::filesystem::path> pictures;
  for (const auto& entry : std::filesystem::directory_iterator(folder_)) {
    if (entry.path().extension() == ".jpg") pictures.push_back(entry.path());
  }
  // The names begin with layer and attempt: their order is the order of taking.
  std::sort(pictures.begin(), pictures.end());
  const std::size_t kept = static_cast<std::size_t>(kept_);
  for (std::size_t i = 0; i + kept < pictures.size(); ++i) std::filesystem::remove(pictures[i]);
}

}  // namespace biotomy::acquisition
