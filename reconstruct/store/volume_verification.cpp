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
#include <vector>

#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/parallel_pipeline.h>

#include "reconstruct/errors.hpp"
#include "reconstruct/excerpt.hpp"
#include "reconstruct/store/metadata_text.hpp"
#include "reconstruct/store/missing_part.hpp"
#include "reconstruct/store/ome_metadata.hpp"
#include "reconstruct/store/stored_shard.hpp"
#include "reconstruct/store/volume_comparison.hpp"
#include "reconstruct/store/volume_misfit.hpp"

namespace biotomy::reconstruct {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kShardsInFlight = 3;
constexpr double kMostShards = 1e8;        // a file each: more than a file system is made for
constexpr std::int64_t kMostListed = 100;  // of what is missing

/// A SampleError's message begins with the file, which the finding names itself.
std::string without_name(const std::string& message, const fs::path& file) {
  const std::string begin = file.string() + ": ";
  return message.rfind(begin, 0) == 0 ? message.substr(begin.size()) : message;
}

/// A shard on its way from reading to decoding.
struct ReadShard {
  fs::path path;
  std::optional<StoredShard> shard;
  std::string fault;  ///< of reading it
};

class VolumeVerification {
 public:
  VolumeVerification(const SampleFolder& sample, const VerificationListener& listener,
                     const SampleGrowth& growth)
      : sample_(sample), listener_(listener), growth_(growth), volume_(sample.volume_path()) {}

  std::int64_t run(bool deep) {
    if (!check_metadata() || !check_shard_count()) {
      return 0;
    }
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
      VolumeComparison comparison(
          sample_, growth_, group_, arrays_,
          [this](const ShardPlace& place) { return is_known_to_be_bad(place); });
      for (std::size_t level = 0; level < arrays_.size(); ++level) {
        compare_level(level, comparison);
      }
    }
    return static_cast<std::int64_t>(shards.size());
  }

 private:
  void found(const fs::path& file, const std::string& what) { listener_.found({file, what}); }
  void count_one() { listener_.progress(++done_, total_); }

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
      there_.insert(shard_path(volume_, place));
    }
    std::int64_t missing = 0;
    for (std::size_t level = 0; level < arrays_.size(); ++level) {
      const BlockCount shards = shards_of(arrays_[level]);
      const std::int64_t depth = arrays_[level].layout.shard[0];
      for (std::int64_t z = 0; z * depth < layers_present_at(group_, level); ++z) {
        for (std::int64_t y = 0; y < shards.y; ++y) {
          for (std::int64_t x = 0; x < shards.x; ++x) {
            const fs::path path = shard_path(volume_, {level, z, y, x});
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
    const fs::path path = shard_path(volume_, place);
    const std::int64_t first_layer =  // of level 0's; what has come since the listing is not in it
        place.z * arrays_[place.level].layout.shard[0] * group_.levels[place.level].z;
    const bool was_listed = group_.every_shard && first_layer < group_.layers_present;
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
      shard->path = shard_path(volume_, shards[next++]);
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

  void compare_level(std::size_t level, VolumeComparison& comparison) {
    const BlockCount shards = shards_of(arrays_[level]);
    for (std::int64_t z = 0; z < shards.z; ++z) {
      for (std::int64_t y = 0; y < shards.y; ++y) {
        for (std::int64_t x = 0; x < shards.x; ++x) {
          const ShardPlace place{level, z, y, x};
          if (const auto fault = comparison.fault_of(place)) {
            found(shard_path(volume_, place), *fault);
          }
          count_one();
        }
      }
    }
  }

  const SampleFolder& sample_;
  const VerificationListener& listener_;
  const SampleGrowth& growth_;
  fs::path volume_;
  VolumeMetadata group_;  ///< as it was when the shards were listed
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
