#include "acquisition/records/rejected_frames.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <utility>
#include <vector>

#include <opencv2/imgproc.hpp>

#include "reconstruct/disk/durable_file.hpp"
#include "reconstruct/picture/jpeg_writer.hpp"

namespace biotomy::acquisition {
namespace {

constexpr int kJpegQuality = 85;

cv::Mat small_rgb(const cv::Mat& image, int width_px) {
  cv::Mat small = image;
  const int longest = std::max(image.cols, image.rows);
  if (longest > width_px) {
    const double factor = static_cast<double>(width_px) / longest;
    cv::resize(image, small, {}, factor, factor, cv::INTER_AREA);
  }
  return small;
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
  reconstruct::write_durably(
      path, reconstruct::encode_jpeg(small_rgb(image, width_px_), {}, kJpegQuality));
  remove_oldest();
  return path;
}

void RejectedFrames::remove_oldest() const {
  std::vector<std::pair<std::pair<long long, int>, std::filesystem::path>> pictures;
  for (const auto& entry : std::filesystem::directory_iterator(folder_)) {
    const std::string name = entry.path().filename().string();
    long long layer = 0;
    int attempt = 0;
    if (std::sscanf(name.c_str(), "%lld-a%d-", &layer, &attempt) == 2) {
      pictures.push_back({{layer, attempt}, entry.path()});
    }
  }
  std::sort(pictures.begin(), pictures.end());  // in the order of taking
  const std::size_t kept = static_cast<std::size_t>(kept_);
  for (std::size_t i = 0; i + kept < pictures.size(); ++i)
    std::filesystem::remove(pictures[i].second);
}

}  // namespace biotomy::acquisition
