#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <opencv2/core.hpp>

#include "reconstruct/sample/sample_folder.hpp"
#include "reconstruct/sample/sample_growth.hpp"
#include "reconstruct/store/ome_metadata.hpp"
#include "reconstruct/store/zarr_array.hpp"

namespace biotomy::reconstruct {

/// A shard's place in the volume.
struct ShardPlace {
  std::size_t level = 0;
  std::int64_t z = 0;
  std::int64_t y = 0;
  std::int64_t x = 0;
};

std::filesystem::path shard_path(const std::filesystem::path& volume, const ShardPlace& place);

/// Compares the voxels of a volume: level 0 with the sample's layer files, every other level with
/// the means of the one before. Memory holds a few shards. The volume may grow meanwhile: a shard
/// that differs is compared again once the volume has other layers.
class VolumeComparison {
 public:
  using IsBad = std::function<bool(const ShardPlace&)>;

  /// `group` and `arrays` are the volume's metadata; the arrays and the others stay the caller's.
  /// `is_bad` names the shards of which it is told already that they are: they are not compared,
  /// and nothing is compared with them.
  VolumeComparison(const SampleFolder& sample, const SampleGrowth& growth, VolumeMetadata group,
                   const std::vector<ZarrArray>& arrays, IsBad is_bad);

  /// What is wrong with the layers that a shard has; nothing when nothing is.
  std::optional<std::string> fault_of(const ShardPlace& place);

 private:
  std::optional<std::string> fault_now(const ShardPlace& place) const;
  bool has_grown(const ShardPlace& place);
  bool may_be_replaced(const ShardPlace& place) const;
  bool read_layers_present();
  cv::Rect region(std::size_t level, std::int64_t y, std::int64_t x) const;
  std::vector<cv::Mat> stored_layers(std::size_t level, std::int64_t first, std::int64_t end,
                                     std::int64_t y, std::int64_t x) const;
  std::vector<cv::Mat> layer_files(const ShardPlace& place, std::int64_t first,
                                   std::int64_t end) const;
  std::vector<cv::Mat> means_of_finer(const ShardPlace& place, std::int64_t first,
                                      std::int64_t end) const;

  const SampleFolder& sample_;
  const SampleGrowth& growth_;
  std::filesystem::path volume_;
  VolumeMetadata group_;  ///< with the layers that are present by now
  const std::vector<ZarrArray>& arrays_;
  IsBad is_bad_;
};

}  // namespace biotomy::reconstruct
