#include "acquisition/viewer/layer_images.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include <nlohmann/json.hpp>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "acquisition/quality/frame_measures.hpp"
#include "acquisition/quality/sharpness_comparison.hpp"
#include "acquisition/viewer/file_version.hpp"
#include "acquisition/viewer/refusal.hpp"
#include "acquisition/viewer/request_text.hpp"
#include "acquisition/viewer/section_query.hpp"
#include "acquisition/viewer/time_allowed.hpp"
#include "reconstruct/errors.hpp"
#include "reconstruct/picture/jpeg_writer.hpp"
#include "reconstruct/sample/layer_image.hpp"
#include "reconstruct/section/section_record.hpp"

namespace biotomy::acquisition {
namespace {

constexpr std::size_t kMadeBytes = std::size_t{64} << 20;
constexpr int kWidest = 4096;
constexpr int kQuality = 90;
constexpr int kMostShift = 20;

/// A tile whose gradient is not stronger than its noise tells nothing.
constexpr double kLeastSignal = 1.0;

std::string jpeg_of(const cv::Mat& rgb) {
  const std::vector<std::byte> file = reconstruct::encode_jpeg(rgb, {}, kQuality);
  return {reinterpret_cast<const char*>(file.data()), file.size()};
}

int divided_up(int size, int shift) {
  return static_cast<int>((std::int64_t{size} + (std::int64_t{1} << shift) - 1) >> shift);
}

cv::Mat scaled_to(const cv::Mat& image, int width) {
  if (image.cols <= width) return image;
  const int height = std::max(
      1, static_cast<int>(std::lround(static_cast<double>(image.rows) * width / image.cols)));
  cv::Mat small;
  cv::resize(image, small, {width, height}, 0.0, 0.0, cv::INTER_AREA);
  return small;
}

void check_size(const cv::Size& size, const cv::Size& expected, const std::filesystem::path& file) {
  if (size != expected) {
    throw reconstruct::SampleError(file.string() + ": is not of the sample's size");
  }
}

nlohmann::ordered_json sharpness_json(std::int64_t layer, const FrameMeasures& measures) {
  nlohmann::ordered_json values = nlohmann::ordered_json::array();
  for (const TileMeasures& tile : measures.tiles) {
    if (tile.signal_to_noise() < kLeastSignal) {
      values.push_back(nullptr);
    } else {
      values.push_back(sharpness(tile));
    }
  }
  const TileGrid& grid = measures.grid;
  return {{"layer", layer},
          {"columns", grid.columns},
          {"rows", grid.rows},
          {"tile_width", static_cast<double>(grid.frame.width) / grid.columns},
          {"tile_height", static_cast<double>(grid.frame.height) / grid.rows},
          {"measure",
           "how fine the tile's detail is: the mean of (2 pi f)^2 over it, f in waves per pixel, "
           "without the noise. Higher is sharper, whatever the brightness and the contrast; blur "
           "takes the finest detail first. None where there is less detail than noise."},
          {"values", values}};
}

}  // namespace

cv::Mat reduced(const cv::Mat& image, int shift) {
  if (shift == 0) return image;
  const int block = 1 << shift;
  const cv::Size size(divided_up(image.cols, shift), divided_up(image.rows, shift));
  if (size.width * block == image.cols && size.height * block == image.rows) {
    cv::Mat whole;
    cv::resize(image, whole, size, 0.0, 0.0, cv::INTER_AREA);
    return whole;
  }
  // The blocks at the right and the lower edge are not whole: they are the means of what there is.
  cv::Mat result(size, image.type());
  const auto put = [&](const cv::Rect& from, const cv::Rect& to) {
    if (from.empty()) return;
    cv::Mat part;
    cv::resize(image(from), part, to.size(), 0.0, 0.0, cv::INTER_AREA);
    part.copyTo(result(to));
  };
  const cv::Size whole(image.cols / block, image.rows / block);
  const cv::Size inner(whole.width * block, whole.height * block);
  const cv::Size rest(image.cols - inner.width, image.rows - inner.height);
  put({0, 0, inner.width, inner.height}, {0, 0, whole.width, whole.height});
  put({inner.width, 0, rest.width, inner.height}, {whole.width, 0, 1, whole.height});
  put({0, inner.height, inner.width, rest.height}, {0, whole.height, whole.width, 1});
  put({inner.width, inner.height, rest.width, rest.height}, {whole.width, whole.height, 1, 1});
  return result;
}

/// A layer's file, and which content of it.
struct LayerImages::Place {
  std::int64_t layer = 0;
  std::filesystem::path file;
  std::string version;
  cv::Size size;
};

LayerImages::LayerImages(LiveSample& live, const LayerRecords& records, tbb::task_arena& arena,
                         std::size_t decoded_bytes)
    : live_(live), records_(records), arena_(arena), decoded_(decoded_bytes), made_(kMadeBytes) {}

LayerImages::Place LayerImages::place_of(std::int64_t layer) const {
  const auto view = live_.look();
  const reconstruct::SampleFolder& sample = view->sample.folder;
  const reconstruct::GridSize& size = sample.description().cuboid.size;
  Place place{layer, {}, {}, {static_cast<int>(size.x), static_cast<int>(size.y)}};
  if (layer >= 1 && layer <= size.z) {
    place.file = sample.layer_path(layer);
    place.version = file_version(place.file);
  }
  if (place.version.empty()) {
    throw Refusal(404, "there is no image of layer " + std::to_string(layer) + ": the sample has " +
                           std::to_string(view->sample.tail.layers_present()) + " layers");
  }
  return place;
}

cv::Mat LayerImages::decoded(const Place& place) {
  const std::string key = std::to_string(place.layer) + ' ' + place.version;
  {
    const std::lock_guard lock(mutex_);
    if (const cv::Mat* found = decoded_.find(key); found != nullptr) return *found;
  }
  cv::Mat image = reconstruct::read_layer_image(place.file);
  check_size(image.size(), place.size, place.file);
  const std::lock_guard lock(mutex_);
  decoded_.put(key, image, image.total() * image.elemSize());
  return image;
}

/// Of the image. A small part is read alone: that decodes only the tiles of the file under it.
cv::Mat LayerImages::region(const Place& place, const cv::Rect& wanted) {
  const auto pixels = [](const cv::Size& size) { return std::int64_t{size.width} * size.height; };
  if (2 * pixels(wanted.size()) >= pixels(place.size)) return decoded(place)(wanted);
  {
    const std::lock_guard lock(mutex_);
    const cv::Mat* found = decoded_.find(std::to_string(place.layer) + ' ' + place.version);
    if (found != nullptr) return (*found)(wanted);
  }
  reconstruct::LayerImageReader reader(place.file);
  check_size({reader.width(), reader.height()}, place.size, place.file);
  return reader.read(wanted);
}

ApiResponse LayerImages::kept_or_made(std::int64_t layer, const std::string& what,
                                      const std::string& content_type, const ApiRequest& request,
                                      const Make& make) {
  const Place place = place_of(layer);
  const std::string sha256 = records_.sha256(layer);
  const std::string etag = '"' + (sha256.empty() ? place.version : sha256) + '-' + what + '"';
  ApiResponse response{.status = 200, .content_type = content_type, .headers = {{"ETag", etag}}};
  const auto v = request.query.find("v");
  const bool by_content = v != request.query.end() && v->second.size() >= kDigitsInAddress &&
                          sha256.starts_with(v->second);
  response.headers["Cache-Control"] =
      by_content ? "private, max-age=31536000, immutable" : "private, no-cache";
  if (has_already(request, etag)) {
    response.status = 304;
    return response;
  }
  const std::string key = std::to_string(layer) + ' ' + place.version + ' ' + what;
  Bytes bytes;
  {
    const std::lock_guard lock(mutex_);
    if (const Bytes* found = made_.find(key); found != nullptr) bytes = *found;
  }
  if (!bytes) {
    reconstruct::stop_here_if(request.client_left, "nobody waits for the picture any more");
    bytes = std::make_shared<const std::string>(arena_.execute([&] { return make(place); }));
    const std::lock_guard lock(mutex_);
    made_.put(key, bytes, bytes->size());
  }
  response.body = *bytes;
  return response;
}

ApiResponse LayerImages::image(std::int64_t layer, const ApiRequest& request) {
  refuse_unknown(request.query, std::array<std::string_view, 1>{"width"});
  const auto width = static_cast<int>(
      number_in(request, "width", kWidest, 1, kWidest, "a width in pixels, 1 to 4096"));
  return kept_or_made(
      layer, "w" + std::to_string(width), "image/jpeg", request,
      [&](const Place& place) { return jpeg_of(scaled_to(decoded(place), width)); });
}

ApiResponse LayerImages::tile(std::int64_t layer, int shift, int column, int row,
                              const ApiRequest& request) {
  refuse_unknown(request.query, {});
  const std::string what =
      std::to_string(shift) + '/' + std::to_string(column) + '/' + std::to_string(row);
  const auto make = [&](const Place& place) {
    const cv::Size size(divided_up(place.size.width, shift), divided_up(place.size.height, shift));
    const std::int64_t left = std::int64_t{column} * kLayerTile;
    const std::int64_t top = std::int64_t{row} * kLayerTile;
    if (left >= size.width || top >= size.height) {
      throw Refusal(404, "there is no tile " + what + " of layer " + std::to_string(layer) +
                             ": reduced so far it has " + std::to_string(size.width) + " x " +
                             std::to_string(size.height) + " pixels");
    }
    const cv::Rect from(static_cast<int>(left) << shift, static_cast<int>(top) << shift,
                        kLayerTile << shift, kLayerTile << shift);
    return jpeg_of(reduced(region(place, from & cv::Rect({0, 0}, place.size)), shift));
  };
  if (shift > kMostShift) {
    throw Refusal(404, "there is no tile " + what + ": images are reduced by at most 2^" +
                           std::to_string(kMostShift));
  }
  return kept_or_made(layer, what, "image/jpeg", request, make);
}

ApiResponse LayerImages::sharpness(std::int64_t layer, const ApiRequest& request) {
  refuse_unknown(request.query, {});
  return kept_or_made(layer, "sharpness", "application/json", request, [&](const Place& place) {
    return reconstruct::json_text(sharpness_json(layer, measure_frame(decoded(place))));
  });
}

}  // namespace biotomy::acquisition
