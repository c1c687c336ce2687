#include "reconstruct/import/image_import.hpp"

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <future>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>
#include <oneapi/tbb/info.h>
#include <oneapi/tbb/parallel_pipeline.h>
#include <oneapi/tbb/task_group.h>
#include <opencv2/core.hpp>

#include "reconstruct/disk/durable_file.hpp"
#include "reconstruct/disk/sha256.hpp"
#include "reconstruct/disk/write_behind.hpp"
#include "reconstruct/errors.hpp"
#include "reconstruct/failure_text.hpp"
#include "reconstruct/geometry/spacing.hpp"
#include "reconstruct/import/partial_import.hpp"
#include "reconstruct/store/layer_band.hpp"
#include "reconstruct/store/volume_writer.hpp"
#include "reconstruct/utf8.hpp"

namespace biotomy::reconstruct {
namespace {

constexpr std::size_t kMiB = std::size_t{1} << 20;

// An image in flight is there as its file, as what the decoder gave and as RGB, later as RGB, as
// compressed tiles and as a TIFF.
constexpr std::size_t kCopiesInFlight = 3;
constexpr std::size_t kBytesInFlight = 1024 * kMiB;
constexpr std::size_t kBytesInFlightBesideABand = 512 * kMiB;
constexpr std::size_t kBytesBehind = 256 * kMiB;
constexpr int kThreadsBehind = 4;  // that wait for the disk at the same time

void check_spacing(const Vector3& spacing) {
  for (const double each : {spacing.x, spacing.y, spacing.z}) {
    if (!is_spacing(each)) {
      throw InvalidRequest(
          "the distance between voxels, also of the coarser levels, must be from 1e-6 to 1e9 "
          "micrometres");
    }
  }
}

Vector3 spacing_of(const std::variant<VoxelSpacing, StackSize>& scale, const GridSize& size) {
  Vector3 spacing;
  if (const auto* stack = std::get_if<StackSize>(&scale)) {
    spacing = {stack->um.x / static_cast<double>(size.x), stack->um.y / static_cast<double>(size.y),
               stack->um.z / static_cast<double>(size.z)};
  } else {
    spacing = std::get<VoxelSpacing>(scale).um;
  }
  check_spacing(spacing);
  return spacing;
}

SampleDescription description_of(const ImageSequence& images, const ImportRequest& request) {
  SampleDescription description;
  description.name = request.name;
  description.notes = request.notes;
  description.created = request.created;
  description.bits = images.bits();
  description.repeated_layers = images.repeated();
  description.cuboid.size = {images.size().width, images.size().height, images.count()};
  description.cuboid.spacing = spacing_of(request.scale, description.cuboid.size);
  for (const LevelFactor& factor : pyramid_factors(description.cuboid, request.layout.chunk)) {
    check_spacing(pyramid_level(description.cuboid, factor).spacing);
  }
  return description;
}

/// The work from the images to a complete sample in its partial folder.
class ImportWork {
 public:
  ImportWork(const ImageSequence& images, const ImportRequest& request, PartialImport& partial,
             const ImportProgress& progress, const StopRequested& stop)
      : images_(images),
        request_(request),
        partial_(partial),
        progress_(progress),
        stop_(stop),
        volume_(partial.sample(), request.layout),
        image_bytes_(static_cast<std::size_t>(images.size().area()) *
                     static_cast<std::size_t>(images.bits() / 8) * 3),
        band_bytes_(image_bytes_ * static_cast<std::size_t>(std::min<std::int64_t>(
                                       volume_.band_depth(), images.count()))) {}
  ~ImportWork() { abandoned_ = true; }
  ImportWork(const ImportWork&) = delete;
  ImportWork& operator=(const ImportWork&) = delete;

  void run() {
    take_back_what_is_not_stored();
    for (std::int64_t first = 0; first < images_.count(); first += volume_.band_depth()) {
      const std::int64_t count =
          std::min<std::int64_t>(volume_.band_depth(), images_.count() - first);
      std::vector<cv::Mat> layers = store_layers(first, count);
      partial_.sync();
      finish_band();
      if (volume_.layers_written() < first + count) {
        append_band(first, count, std::move(layers));
      }
    }
    finish_band();
    disk_.finish();
  }

 private:
  void stop_if_asked() const { stop_here_if(stop_, "the import was interrupted"); }

  /// A band goes into the volume while its layers' files still wait for the disk, and an import
  /// that fails may leave it there without them. Such a layer is stored anew, perhaps of an image
  /// that was replaced, and its band with it.
  void take_back_what_is_not_stored() {
    std::int64_t stored = 0;
    while (stored < images_.count() && partial_.is_stored(stored + 1)) {
      ++stored;
    }
    if (stored < images_.count()) {
      volume_.take_back_to(stored);
    }
  }

  std::size_t images_in_flight() const {
    const std::size_t bytes = bands_in_memory() ? kBytesInFlightBesideABand : kBytesInFlight;
    const auto threads = static_cast<std::size_t>(tbb::info::default_concurrency());
    return std::clamp<std::size_t>(bytes / (kCopiesInFlight * image_bytes_), 1, 2 * threads);
  }

  /// Returns the images of the band's layers, when they fit into memory; those that were stored by
  /// an import before are empty.
  std::vector<cv::Mat> store_layers(std::int64_t first, std::int64_t count) {
    std::vector<cv::Mat> kept(static_cast<std::size_t>(count));
    std::int64_t next = 0;
    const auto number = [&](tbb::flow_control& control) {
      while (next < count && partial_.is_stored(first + next + 1)) {
        ++next;
      }
      if (next == count) {
        control.stop();
      }
      return next++;
    };
    const auto store = [&](std::int64_t place) {
      stop_if_asked();
      const std::int64_t layer = first + place + 1;
      const cv::Mat image = images_.read(layer);
      std::vector<std::byte> file = encode_layer_image(
          partial_.sample().layer_path(layer), image,
          {layer, partial_.sample().description().cuboid.spacing}, request_.layer_format);
      // When another image has failed, parallel work in here may have ended with a part undone.
      if (tbb::is_current_task_group_canceling()) {
        return;
      }
      store_file(layer, std::move(file));
      if (bands_in_memory()) {
        kept[static_cast<std::size_t>(place)] = image;
      }
    };
    tbb::parallel_pipeline(
        images_in_flight(),
        tbb::make_filter<void, std::int64_t>(tbb::filter_mode::serial_in_order, number) &
            tbb::make_filter<std::int64_t, void>(tbb::filter_mode::parallel, store));
    return kept;
  }

  void store_file(std::int64_t layer, std::vector<std::byte> file) {
    const std::size_t size = file.size();
    disk_.add(size, [this, layer, bytes = std::move(file)] {
      write_before_folder_sync(partial_.sample().layer_path(layer), bytes);
      const std::string hash = sha256(bytes);
      const std::scoped_lock lock(stored_mutex_);
      partial_.add_stored(layer, hash);
      if (progress_) {
        progress_(partial_.stored_layers(), images_.count());
      }
    });
  }

  bool bands_in_memory() const { return band_bytes_ <= request_.most_band_bytes; }

  /// Waits for the band that goes into the volume.
  void finish_band() {
    if (band_.valid()) {
      band_.get();
    }
  }

  void append_band(std::int64_t first, std::int64_t count, std::vector<cv::Mat> layers) {
    const bool in_memory = std::none_of(layers.begin(), layers.end(),
                                        [](const cv::Mat& layer) { return layer.empty(); });
    if (in_memory) {
      band_ = std::async(std::launch::async, [this, count, images = std::move(layers)] {
        append_images(count, images);
      });
      if (2 * band_bytes_ > request_.most_band_bytes) {
        finish_band();  // before the next one is read
      }
      return;
    }
    disk_.finish();  // the layer files are read now
    const LayerBand band(partial_.sample(), first + 1, count);
    volume_.append_band(count, [&](const cv::Rect& region) {
      stop_if_asked();
      return band.read(region);
    });
  }

  void append_images(std::int64_t count, const std::vector<cv::Mat>& images) {
    volume_.append_band(count, [&](const cv::Rect& region) {
      stop_if_asked();
      if (abandoned_) {
        throw Interrupted("the import has failed");  // which was told already
      }
      std::vector<cv::Mat> parts;
      parts.reserve(images.size());
      for (const cv::Mat& image : images) {
        parts.push_back(image(region));
      }
      return parts;
    });
  }

  const ImageSequence& images_;
  const ImportRequest& request_;
  PartialImport& partial_;
  const ImportProgress& progress_;
  const StopRequested& stop_;
  VolumeWriter volume_;
  std::size_t image_bytes_;
  std::size_t band_bytes_;
  std::mutex stored_mutex_;
  WriteBehind disk_{kBytesBehind, kThreadsBehind};
  std::atomic<bool> abandoned_{false};
  std::future<void> band_;  // the last band, on its way into the volume while the next is read
};

/// The end of the message when the work ends before its time. What holds no layer is removed.
std::string leave(PartialImport& partial) {
  const std::int64_t stored = partial.stored_layers();
  if (stored == 0) {
    partial.discard();
    return {};
  }
  return "; " + std::to_string(stored) + " of " +
         std::to_string(partial.sample().description().cuboid.size.z) + " layers are kept in " +
         partial.folder().string() + ": the same command goes on from there, --restart begins anew";
}

}  // namespace

SampleFolder import_images(const ImageSequence& images, const ImportRequest& request,
                           const ImportProgress& progress, const StopRequested& stop) {
  if (!is_utf8(request.name) || !is_utf8(request.notes)) {
    throw InvalidRequest("name and notes must be UTF-8; set the terminal's encoding to it");
  }
  const SampleDescription description = description_of(images, request);
  check_layout(request.layout);
  PartialImport partial(request.output, description, import_record(images, request),
                        request.restart);
  try {
    ImportWork(images, request, partial, progress, stop).run();
    return SampleFolder::open(partial.finish());
  } catch (const Interrupted& error) {
    throw Interrupted(error.what() + leave(partial));
  } catch (const std::exception& error) {
    const std::string kept = leave(partial);
    if (kept.empty()) {
      throw;
    }
    throw SampleError(failure_text(error) + kept);
  }
}

}  // namespace biotomy::reconstruct
