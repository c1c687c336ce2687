#include "reconstruct/sample/image_import.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <mutex>
#include <sstream>
#include <utility>

#include <oneapi/tbb/parallel_pipeline.h>
#include <unistd.h>

#include "reconstruct/errors.hpp"
#include "reconstruct/store/durable_file.hpp"
#include "reconstruct/store/volume_writer.hpp"

namespace biotomy::reconstruct {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kImagesInFlight = 4;

Vector3 spacing_of(const std::variant<VoxelSpacing, StackSize>& scale, const GridSize& size) {
  Vector3 spacing;
  if (const auto* stack = std::get_if<StackSize>(&scale)) {
    spacing = {stack->um.x / static_cast<double>(size.x), stack->um.y / static_cast<double>(size.y),
               stack->um.z / static_cast<double>(size.z)};
  } else {
    spacing = std::get<VoxelSpacing>(scale).um;
  }
  for (const double each : {spacing.x, spacing.y, spacing.z}) {
    if (!std::isfinite(each) || each <= 0.0) {
      throw InvalidRequest("spacings and sizes must be numbers of micrometres above 0");
    }
  }
  return spacing;
}

/// A hidden folder beside the one that it becomes; removed unless it did.
class PartialFolder {
 public:
  explicit PartialFolder(const fs::path& target)
      : target_(fs::absolute(target).lexically_normal()) {
    if (!target_.has_filename()) {
      target_ = target_.parent_path();  // "sample/"
    }
    static std::atomic<unsigned> counter{0};
    std::ostringstream name;
    name << '.' << target_.filename().string() << ".partial-" << ::getpid() << '-' << counter++;
    path_ = target_.parent_path() / name.str();
    refuse_if_taken();
  }
  ~PartialFolder() {
    if (!finished_) {
      std::error_code ignored;
      fs::remove_all(path_, ignored);
    }
  }
  PartialFolder(const PartialFolder&) = delete;
  PartialFolder& operator=(const PartialFolder&) = delete;

  const fs::path& path() const { return path_; }

  /// The final name. rename replaces an empty folder and refuses any other.
  fs::path finish() {
    std::error_code error;
    fs::rename(path_, target_, error);
    if (error) {
      refuse_if_taken();
      throw SampleError(target_.string() +
                        ": cannot give the finished sample its name: " + error.message());
    }
    finished_ = true;
    sync_folder(target_.parent_path());
    return target_;
  }

 private:
  void refuse_if_taken() const {
    std::error_code error;
    if (fs::exists(target_, error) &&
        !(fs::is_directory(target_, error) && fs::is_empty(target_, error))) {
      throw SampleError(target_.string() +
                        ": is there already and not empty; choose another name or remove it");
    }
  }

  fs::path target_;
  fs::path path_;
  bool finished_ = false;
};

}  // namespace

SampleFolder import_images(const ImageSequence& images, const ImportRequest& request,
                           const ImportProgress& progress) {
  SampleDescription description;
  description.name = request.name;
  description.notes = request.notes;
  description.created = request.created;
  description.bits = images.bits();
  description.cuboid.size = {images.size().width, images.size().height, images.count()};
  description.cuboid.spacing = spacing_of(request.scale, description.cuboid.size);
  check_layout(request.layout);

  PartialFolder folder(request.output);
  const SampleFolder sample = SampleFolder::create(folder.path(), description);
  VolumeWriter volume(sample, request.layout);

  std::mutex progress_mutex;
  std::int64_t done = 0;
  const auto store_layer = [&](std::int64_t layer) {
    write_layer_image(sample.layer_path(layer), images.read(layer),
                      {layer, description.cuboid.spacing}, request.layer_format);
    const std::lock_guard lock(progress_mutex);
    ++done;
    if (progress) {
      progress(done, images.count());
    }
  };

  for (std::int64_t first = 1; first <= images.count(); first += volume.band_depth()) {
    const std::int64_t last = std::min(first + volume.band_depth() - 1, images.count());
    std::int64_t next = first;
    const auto number = [&](tbb::flow_control& control) {
      if (next > last) {
        control.stop();
      }
      return next++;
    };
    tbb::parallel_pipeline(
        kImagesInFlight,
        tbb::make_filter<void, std::int64_t>(tbb::filter_mode::serial_in_order, number) &
            tbb::make_filter<std::int64_t, void>(tbb::filter_mode::parallel, store_layer));
    volume.append(last, false);
  }
  return SampleFolder::open(folder.finish());
}

}  // namespace biotomy::reconstruct
