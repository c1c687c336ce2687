#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <opencv2/core/mat.hpp>

#include "reconstruct/geometry/vector3.hpp"

namespace biotomy::reconstruct {

class TiffFile;

enum class LayerCompression { zstd, deflate };

/// How layer images are written: lossless TIFF in tiles of 256 × 256 with the horizontal predictor.
struct LayerFormat {
  LayerCompression compression = LayerCompression::zstd;
  int level = 1;
  /// Bytes; what is larger becomes a BigTIFF, as a TIFF ends at 4 GiB.
  std::uint64_t largest_classic_tiff = 0xF0000000;
};

/// What is written into the file beside the pixels.
struct LayerPosition {
  std::int64_t layer = 0;  ///< section number, from 1
  Vector3 spacing;         ///< micrometres; x and y become the resolution, z the position
};

/// What was stored: enough to find out later whether it is still the same.
struct StoredLayer {
  std::uint64_t bytes = 0;
  std::string sha256;  ///< of the file, lower-case hexadecimal, as sha256sum prints it
};

/// The file of a layer image, complete: `image` (CV_8UC3 or CV_16UC3, R G B) in tiles that are
/// compressed in parallel. `path` is for messages only. Throws SampleError.
std::vector<std::byte> encode_layer_image(const std::filesystem::path& path, const cv::Mat& image,
                                          const LayerPosition& position, const LayerFormat& format);

/// Gives a prepared layer its name, for good; to be called once. Whoever lets go of it without a
/// call gives the layer up, and nothing remains of it. Throws SampleError.
using PublishLayer = std::function<StoredLayer()>;

/// All of storing a layer but its name: `image` is encoded, written beside `path`, fsynced, read
/// back and compared. What was there under `path` stays. Throws SampleError.
PublishLayer prepare_layer_image(const std::filesystem::path& path, const cv::Mat& image,
                                 const LayerPosition& position, const LayerFormat& format);

/// Prepares and publishes. Replaces a file of that name. Throws SampleError; then no file of that
/// name is new.
StoredLayer write_layer_image(const std::filesystem::path& path, const cv::Mat& image,
                              const LayerPosition& position, const LayerFormat& format);

/// The whole image, CV_8UC3 or CV_16UC3, R G B. Throws SampleError when the file is missing,
/// truncated or not such an image.
cv::Mat read_layer_image(const std::filesystem::path& path);

/// Reads regions of one layer image without reading all of it. Not for two threads at once. Both
/// constructor and `read` throw SampleError, which names the file.
class LayerImageReader {
 public:
  explicit LayerImageReader(const std::filesystem::path& path);
  ~LayerImageReader();
  LayerImageReader(const LayerImageReader&) = delete;
  LayerImageReader& operator=(const LayerImageReader&) = delete;

  int width() const { return width_; }
  int height() const { return height_; }
  int type() const { return type_; }  ///< CV_8UC3 or CV_16UC3

  /// The pixels of `region`, which lies inside the image.
  cv::Mat read(const cv::Rect& region);

 private:
  std::unique_ptr<TiffFile> file_;
  int width_ = 0;
  int height_ = 0;
  int tile_width_ = 0;
  int tile_height_ = 0;
  int type_ = 0;
};

}  // namespace biotomy::reconstruct
