#include "reconstruct/store/volume_verification.hpp"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/parallel_pipeline.h>
#include <opencv2/core.hpp>

#include "reconstruct/errors.hpp"
#include "reconstruct/excerpt.hpp"
#include "reconstruct/store/layer_band.hpp"
#include "reconstruct/store/level_mean.hpp"
#include "reconstruct/store/metadata_text.hpp"
#include "reconstruct/store/missing_part.hpp"
#include "reconstruct/store/ome_metadata.hpp"
#include "reconstruct/store/pyramid_writer.hpp"
#include "reconstruct/store/shard_layers.hpp"
#include "reconstruct/store/stored_shard.hpp"
#include "reconstruct/store/volume_misfit.hpp"

namespace biotomy::reconstruct {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kShardsInFlight = 3;
constexpr double kMostShards = 1e8;        // a file each: more than a file system is made for
constexpr std::int64_t kMostListed = 100;  // of what is missing
constexpr int kMostComparisons = 4;        // of one shard: no volume grows that quickly

/// A SampleError's message begins with the file, which the finding names itself.
std::string without_name(const std::string& message, const fs::path& file) {
  const std::string begin = file.string() + ": ";
  return message.rfind(begin, 0) == 0 ? message.substr(begin.size()) : message;
}

/// A shard's place in the volume.
struct ShardPlace {
  std::size_t level = 0;
  std::int64_t z = 0;
  std::int64_t y = 0;
  std::int64_t x = 0;
};

/// A shard on its way from reading to decoding.
struct ReadShard {
  fs::path path;
  std::optional<StoredShard> shard;
  std::string fault;  ///< of reading it
};

/// The first difference of two stacks of layers of one size.
std::optional<std::string> difference(const std::vector<cv::Mat>& found,
                                      const std::vector<cv::Mat>& expected) {
  for (std::size_t k = 0; k < found.size(); ++k) {
    const std::size_t row_bytes = static_cast<std::size_t>(found[k].cols) * found[k].elemSize();
    for (int y = 0; y < found[k].rows; ++y) {
      const unsigned char* a = found[k].ptr(y);
      const unsigned char* b = expected[k].ptr(y);
      const auto place = std::mismatch(a, a + row_bytes, b);
      if (place.first != a + row_bytes) {
        const auto x = static_cast<std::size_t>(place.first - a) / found[k].elemSize();
        return "at x " + std::to_string(x) + ", y " + std::to_string(y) + ", z " +
               std::to_string(k) + " of the shard";
      }
    }
  }
  return std::nullopt;
}

class VolumeVerification {
 public:
  VolumeVerification(const SampleFolder& sample, const VerificationListener& listener,
                     const SampleGrowth& growth)
      : sample_(sample), listener_(listener), growth_(growth), volume_(sample.volume_path()) {}

  std::int64_t run(bool deep) {
    if (!check_metadata() || !check_shard_count()) {
      return 0;
    }
    layers_listed_ = group_.layers_present;
    check_layers_present();
    const std::vector<ShardPlace> shards = stored_shards();
    if (group_.every_shard) {
      check_missing(shards);
    }
    total_ = static_cast<std::int64_t>(shards.size());
    if (deep) {
      for (const ZarrArray& array : arrays_) {
        total_ += shards_of(array).total();
      }
    }
    decode_all(shards);
    if (deep) {
      for (std::size_t level = 0; level < arrays_.size(); ++level) {
        compare_level(level);
      }
    }
    return static_cast<std::int64_t>(shards.size());
  }

 private:
  void found(const fs::path& file, const std::string& what) { listener_.found({file, what}); }
  void count_one() { listener_.progress(++done_, total_); }

  fs::path shard_path(const ShardPlace& place) const {
    return volume_ / level_path(static_cast<int>(place.level)) /
           shard_key(place.z, place.y, place.x);
  }

  /// False when nothing more can be said of the volume.
  bool check_metadata() {
    const fs::path group_path = volume_ / kMetadataName;
    try {
      group_ = parse_group_metadata(read_metadata_file(group_path), group_path.string());
    } catch (const SampleError& error) {
      found(group_path, without_name(error.what(), group_path));
      return false;
    }
    const SampleDescription& description = sample_.description();
    // The size is the arrays' to tell.
    if (const auto what = misfit({description.cuboid.size, group_.spacing}, group_.bits, sample_)) {
      found(group_path, *what);
    }
    if (group_.name != description.name) {
      found(group_path, "names the sample '" + excerpt(group_.name) + "', and sample.toml '" +
                            excerpt(description.name) + "'; biotomy rebuild " +
                            sample_.path().string() + " takes over the latter");
    }
    for (std::size_t level = 0; level < group_.levels.size(); ++level) {
      if (!check_array(level)) {
        return false;
      }
    }
    if (group_.levels != pyramid_factors(description.cuboid, arrays_.front().layout.chunk)) {
      found(group_path, "has not the levels that it must have; biotomy rebuild makes them");
    }
    return true;
  }

  bool check_array(std::size_t level) {
    const fs::path path = volume_ / level_path(static_cast<int>(level)) / kMetadataName;
    const Cuboid& cuboid = sample_.description().cuboid;
    try {
      const ZarrArray array = parse_array_metadata(read_metadata_file(path), path.string());
      if (level == 0) {
        if (const auto what =
                misfit({array.size, cuboid.spacing}, sample_.description().bits, sample_)) {
          found(path, *what);
          return false;
        }
      }
      ZarrArray expected = level == 0 ? array : arrays_.front();
      expected.size = pyramid_level(cuboid, group_.levels[level]).size;
      expected.bits = group_.bits;
      if (array != expected) {
        found(path, "does not fit the sample and the other levels");
        return false;
      }
      arrays_.push_back(array);
      return true;
    } catch (const SampleError& error) {
      found(path, without_name(error.what(), path));
      return false;
    }
  }

  void check_layers_present() {
    std::int64_t files = 0;  // without a gap: a volume is made of no others
    std::error_code error;
    while (files < sample_.description().cuboid.size.z &&
           fs::exists(sample_.layer_path(files + 1), error)) {
      ++files;
    }
    const std::int64_t present = group_.layers_present;
    const std::string counts =
        "holds " + std::to_string(present) + " layers; " +
        (files == 0 ? std::string("there is no layer file 1")
                    : "layer files 1 to " + std::to_string(files) + " follow without a gap");
    const bool complete = files == sample_.description().cuboid.size.z;
    const std::int64_t depth = arrays_.front().layout.shard[0];
    const bool lacks_some = files - present >= depth || (complete && present < files);
    const bool on_their_way = files - present < 2 * depth && growth_.is_seen();
    if (present > files || (lacks_some && !on_their_way)) {
      found(volume_, counts);
    }
  }

  std::vector<ShardPlace> stored_shards() {
    std::vector<ShardPlace> places;
    for (std::size_t level = 0; level < arrays_.size(); ++level) {
      const fs::path folder = volume_ / level_path(static_cast<int>(level));
      std::error_code error;
      for (auto entry = fs::recursive_directory_iterator(folder, error);
           !error && entry != fs::recursive_directory_iterator(); entry.increment(error)) {
        const std::string name = entry->path().lexically_relative(folder).generic_string();
        const bool hidden = entry->path().filename().string().front() == '.';  // never finished
        if (entry->is_directory() || hidden || name == kMetadataName) {
          continue;
        }
        if (const auto place = place_of(level, name)) {
          places.push_back(*place);
        } else {
          found(entry->path(), "does not belong to the volume");
        }
      }
      if (error) {
        found(folder, "cannot be listed: " + error.message());
      }
    }
    return places;
  }

  std::optional<ShardPlace> place_of(std::size_t level, const std::string& name) const {
    std::array<std::int64_t, 3> numbers{};
    const char* text = name.c_str();
    if (name.rfind("c/0", 0) != 0) {
      return std::nullopt;
    }
    text += 3;
    for (std::int64_t& number : numbers) {
      char* end = nullptr;
      number = *text == '/' ? std::strtoll(text + 1, &end, 10) : -1;
      if (number < 0) {
        return std::nullopt;
      }
      text = end;
    }
    const BlockCount shards = shards_of(arrays_[level]);
    const auto& [z, y, x] = numbers;
    // Written out again, so that "01" and "1x" are not taken for 1.
    if (z >= shards.z || y >= shards.y || x >= shards.x || shard_key(z, y, x) != name) {
      return std::nullopt;
    }
    return ShardPlace{level, z, y, x};
  }

  /// What metadata may say without end is not worked through, nor told, without end.
  bool check_shard_count() {
    double shards = 0;
    for (const ZarrArray& array : arrays_) {
      const BlockCount count = shards_of(array);
      shards += static_cast<double>(count.z) * static_cast<double>(count.y) *
                static_cast<double>(count.x);
    }
    if (shards > kMostShards) {
      found(volume_ / kMetadataName, "says that there are more shards than a volume can have");
      return false;
    }
    return true;
  }

  void check_missing(const std::vector<ShardPlace>& stored) {
    for (const ShardPlace& place : stored) {
      there_.insert(shard_path(place));
    }
    std::int64_t missing = 0;
    for (std::size_t level = 0; level < arrays_.size(); ++level) {
      const BlockCount shards = shards_of(arrays_[level]);
      const std::int64_t depth = arrays_[level].layout.shard[0];
      for (std::int64_t z = 0; z * depth < layers_present_at(group_, level); ++z) {
        for (std::int64_t y = 0; y < shards.y; ++y) {
          for (std::int64_t x = 0; x < shards.x; ++x) {
            const fs::path path = shard_path({level, z, y, x});
            if (!there_.contains(path) && ++missing <= kMostListed) {
              found(path, kIsMissing);
            }
          }
        }
      }
    }
    if (missing > kMostListed) {
      found(volume_, std::to_string(missing - kMostListed) + " more shards are missing");
    }
  }

  /// Of which a finding tells already.
  bool is_known_to_be_bad(const ShardPlace& place) const {
    const fs::path path = shard_path(place);
    const std::int64_t first_layer =  // of level 0's; what has come since the listing is not in it
        place.z * arrays_[place.level].layout.shard[0] * group_.levels[place.level].z;
    const bool was_listed = group_.every_shard && first_layer < layers_listed_;
    return damaged_.contains(path) || (was_listed && !there_.contains(path));
  }

  void decode_all(const std::vector<ShardPlace>& shards) {
    std::size_t next = 0;
    const auto read = [&](tbb::flow_control& control) -> std::shared_ptr<ReadShard> {
      if (next == shards.size()) {
        control.stop();
        return nullptr;
      }
      auto shard = std::make_shared<ReadShard>();
      shard->path = shard_path(shards[next++]);
      try {
        shard->shard = StoredShard::open(shard->path, arrays_[0]);
      } catch (const SampleError& error) {
        shard->fault = without_name(error.what(), shard->path);
      }
      return shard;
    };
    const auto decode = [&](const std::shared_ptr<ReadShard>& shard) { decode_chunks(*shard); };
    tbb::parallel_pipeline(kShardsInFlight, tbb::make_filter<void, std::shared_ptr<ReadShard>>(
                                                tbb::filter_mode::serial_in_order, read) &
                                                tbb::make_filter<std::shared_ptr<ReadShard>, void>(
                                                    tbb::filter_mode::parallel, decode));
  }

  void decode_chunks(const ReadShard& shard) {
    std::vector<std::string> faults;
    if (!shard.fault.empty()) {
      faults.push_back(shard.fault);
    }
    const ChunkCodec codec(arrays_[0].layout, arrays_[0].bits);
    const auto chunks = static_cast<std::size_t>(chunks_of_shard(arrays_[0].layout).total());
    std::mutex faults_mutex;
    tbb::parallel_for(std::size_t{0}, shard.shard ? chunks : 0, [&](std::size_t chunk) {
      if (!shard.shard->stores(chunk)) {
        return;
      }
      try {
        std::vector<std::byte> voxels(codec.chunk_bytes());
        shard.shard->decode(chunk, codec, voxels);
      } catch (const SampleError& error) {
        const std::scoped_lock lock(faults_mutex);
        faults.push_back(without_name(error.what(), shard.path));
      }
    });
    std::sort(faults.begin(), faults.end());
    const std::scoped_lock lock(mutex_);
    for (const std::string& fault : faults) {
      found(shard.path, fault);
      damaged_.insert(shard.path);
    }
    count_one();
  }

  cv::Rect region(std::size_t level, std::int64_t y, std::int64_t x) const {
    const ZarrArray& array = arrays_[level];
    const auto& shard = array.layout.shard;
    return cv::Rect(static_cast<int>(x) * shard[2], static_cast<int>(y) * shard[1], shard[2],
                    shard[1]) &
           cv::Rect(0, 0, static_cast<int>(array.size.x), static_cast<int>(array.size.y));
  }

  /// Layers `first` to before `end` of a column of shards. Throws SampleError.
  std::vector<cv::Mat> stored_layers(std::size_t level, std::int64_t first, std::int64_t end,
                                     std::int64_t y, std::int64_t x) const {
    const ZarrArray& array = arrays_[level];
    const std::int64_t depth = array.layout.shard[0];
    std::vector<cv::Mat> layers;
    for (std::int64_t layer = first; layer < end;) {
      const std::int64_t z = layer / depth;
      const std::int64_t count = std::min(end, (z + 1) * depth) - layer;
      const auto shard = StoredShard::open(shard_path({level, z, y, x}), array);
      for (cv::Mat& each : shard_layers(shard, array, static_cast<int>(layer - z * depth),
                                        static_cast<int>(count), region(level, y, x).size())) {
        layers.push_back(std::move(each));
      }
      layer += count;
    }
    return layers;
  }

  void compare_level(std::size_t level) {
    const BlockCount shards = shards_of(arrays_[level]);
    for (std::int64_t z = 0; z < shards.z; ++z) {
      for (std::int64_t y = 0; y < shards.y; ++y) {
        for (std::int64_t x = 0; x < shards.x; ++x) {
          compare_shard({level, z, y, x});
          count_one();
        }
      }
    }
  }

  void compare_shard(const ShardPlace& place) {
    std::optional<std::string> fault = fault_of(place);
    for (int i = 1; fault && i < kMostComparisons && has_grown(place); ++i) {
      fault = fault_of(place);
    }
    if (fault) {
      found(shard_path(place), *fault);
    }
  }

  /// Whether the volume has other layers now than when the shard was compared. Shards are replaced
  /// before the metadata says so: where that may explain a difference, it is waited for.
  bool has_grown(const ShardPlace& place) {
    bool waits = may_be_replaced(place);
    while (!read_layers_present()) {
      if (!waits) {
        return false;
      }
      waits = growth_.wait();
    }
    return true;
  }

  /// Of a shard that there is, only the level's last layer becomes another, and only while it is
  /// the mean of fewer layers than it can be.
  bool may_be_replaced(const ShardPlace& place) const {
    const std::int64_t depth = arrays_[place.level].layout.shard[0];
    const std::int64_t layers = layers_present_at(group_, place.level);
    return layers * group_.levels[place.level].z > group_.layers_present &&
           layers <= (place.z + 1) * depth;
  }

  /// False when they are as many as before.
  bool read_layers_present() {
    const fs::path group_path = volume_ / kMetadataName;
    try {
      const std::int64_t layers =
          parse_group_metadata(read_metadata_file(group_path), group_path.string()).layers_present;
      return std::exchange(group_.layers_present, layers) != layers;
    } catch (const SampleError&) {
      return false;  // it was read before, and what is compared needs no more of it
    }
  }

  /// What is wrong with a shard of those layers that the volume has now.
  std::optional<std::string> fault_of(const ShardPlace& place) const {
    const std::int64_t depth = arrays_[place.level].layout.shard[0];
    const std::int64_t first = place.z * depth;
    const std::int64_t end = std::min(first + depth, layers_present_at(group_, place.level));
    if (first >= end || is_known_to_be_bad(place)) {
      return std::nullopt;  // the latter was told before
    }
    try {
      const auto stored = stored_layers(place.level, first, end, place.y, place.x);
      const auto expected =
          place.level == 0 ? layer_files(place, first, end) : means_of_finer(place, first, end);
      if (expected.empty()) {
        return std::nullopt;  // of what it is made is damaged, which was told before
      }
      if (const auto where = difference(stored, expected)) {
        return (place.level == 0
                    ? "is not what the layer files hold: "
                    : "is not the mean of level " + std::to_string(place.level - 1) + ": ") +
               *where;
      }
      return std::nullopt;
    } catch (const SampleError& error) {
      return std::string("cannot be compared: ") + error.what();
    }
  }

  std::vector<cv::Mat> layer_files(const ShardPlace& place, std::int64_t first,
                                   std::int64_t end) const {
    return LayerBand(sample_, first + 1, end - first).read(region(0, place.y, place.x));
  }

  std::vector<cv::Mat> means_of_finer(const ShardPlace& place, std::int64_t first,
                                      std::int64_t end) const {
    const std::size_t finer = place.level - 1;
    const HalvedAxes axes = halved_axes(group_.levels[finer], group_.levels[place.level]);
    const BlockCount shards = shards_of(arrays_[finer]);
    const std::int64_t depth = arrays_[finer].layout.shard[0];
    const std::int64_t finer_first = axes.z ? 2 * first : first;
    const std::int64_t finer_end =
        std::min(axes.z ? 2 * end : end, layers_present_at(group_, finer));
    const cv::Rect whole = region(place.level, place.y, place.x);
    std::vector<cv::Mat> means(static_cast<std::size_t>(end - first));
    for (cv::Mat& mean : means) {
      mean.create(whole.size(), group_.bits == 8 ? CV_8UC3 : CV_16UC3);
    }
    for (std::int64_t dy = 0; dy <= (axes.y ? 1 : 0); ++dy) {
      for (std::int64_t dx = 0; dx <= (axes.x ? 1 : 0); ++dx) {
        const std::int64_t y = (axes.y ? 2 * place.y : place.y) + dy;
        const std::int64_t x = (axes.x ? 2 * place.x : place.x) + dx;
        if (y >= shards.y || x >= shards.x) {
          continue;
        }
        for (std::int64_t z = finer_first / depth; z * depth < finer_end; ++z) {
          if (is_known_to_be_bad({finer, z, y, x})) {
            return {};
          }
        }
        const auto part = level_mean(stored_layers(finer, finer_first, finer_end, y, x), axes);
        const cv::Point corner = region(finer, y, x).tl();
        const cv::Rect inside(
            cv::Point(corner.x / (axes.x ? 2 : 1), corner.y / (axes.y ? 2 : 1)) - whole.tl(),
            part.front().size());
        for (std::size_t k = 0; k < means.size(); ++k) {
          part[k].copyTo(means[k](inside));
        }
      }
    }
    return means;
  }

  const SampleFolder& sample_;
  const VerificationListener& listener_;
  const SampleGrowth& growth_;
  fs::path volume_;
  VolumeMetadata group_;            ///< with the layers that are present by now
  std::int64_t layers_listed_ = 0;  ///< present when the shards were listed
  std::vector<ZarrArray> arrays_;
  std::mutex mutex_;
  std::set<fs::path> there_;  ///< where every shard is stored
  std::set<fs::path> damaged_;
  std::int64_t done_ = 0;
  std::int64_t total_ = 0;
};

}  // namespace

std::int64_t verify_volume(const SampleFolder& sample, bool deep,
                           const VerificationListener& listener, const SampleGrowth& growth) {
  std::error_code error;
  if (!fs::exists(sample.volume_path(), error)) {
    listener.found({sample.volume_path(), "is missing; biotomy rebuild makes it"});
    return 0;
  }
  return VolumeVerification(sample, listener, growth).run(deep);
}

}  // namespace biotomy::reconstruct
