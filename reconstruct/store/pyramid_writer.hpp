#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <vector>

#include <opencv2/core/mat.hpp>

#include "reconstruct/store/pyramid.hpp"
#include "reconstruct/store/zarr_array.hpp"

namespace biotomy::reconstruct {

/// Gives a region of a face, the same of each layer of a band, CV_8UC3 or CV_16UC3.
using BandRegions = std::function<std::vector<cv::Mat>(const cv::Rect& region)>;

/// The arrays of all levels of a volume: level 0's, and those that differ from it in size alone.
std::vector<ZarrArray> level_arrays(const ZarrArray& finest,
                                    const std::vector<LevelFactor>& factors);

/// Writes the shards of a volume's levels, a band of layers (one shard deep) at a time.
///
/// A level's voxel is the mean of the voxels of the level before that exist when the band is
/// written. Layer k of a level that halves z is computed from the layers 2k and 2k + 1 of the level
/// before, as they are stored, and is computed anew when 2k + 1 comes with a later band. So the
/// bytes of a volume depend on its layers alone, not on how often or when it was appended to. A
/// shard of a level that halves z spans several bands: with each it is written anew, with the
/// layers that it had. Every shard is stored, also one that is all fill value.
///
/// The levels are computed shard by shard, each from the shards that it covers: memory holds a few
/// regions of the size of a shard, whatever the size of a layer.
class PyramidWriter {
 public:
  /// `volume` is the folder of the group; the arrays of `factors` are there. `every_shard` is what
  /// the group says (VolumeMetadata): whether a shard of earlier bands that is missing is an error.
  PyramidWriter(std::filesystem::path volume, const ZarrArray& finest,
                std::vector<LevelFactor> factors, bool every_shard);

  /// Stores layers `first_layer` (from 0, where a shard begins) to `first_layer + layer_count − 1`
  /// durably in all levels. What the shards hold of deeper layers becomes fill value. `band` is
  /// called for one region after the other, by one thread. Throws SampleError.
  void write_band(std::int64_t first_layer, std::int64_t layer_count, const BandRegions& band);

 private:
  class BandOfLevels;

  std::filesystem::path volume_;
  std::vector<LevelFactor> factors_;
  std::vector<ZarrArray> arrays_;
  bool every_shard_;
};

}  // namespace biotomy::reconstruct
