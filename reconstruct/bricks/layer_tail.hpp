#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <opencv2/core/mat.hpp>

#include "reconstruct/sample/sample_folder.hpp"
#include "reconstruct/store/volume.hpp"

namespace biotomy::reconstruct {

/// The layers of a sample that are on disk as images but not yet in its volume: while a job runs,
/// up to a band of them. Laid over the volume they make every level what it will be once it holds
/// them.
///
/// It is a snapshot: layers that are stored later are not in it, and what a writer puts into the
/// volume meanwhile changes nothing. From the volume it takes only the layers of a level whose
/// voxels were complete when the volume was opened, and those never change.
///
/// Safe for many threads.
class LayerTail {
 public:
  /// Finds the layers. The volume must outlive it. Throws SampleError when there are some and the
  /// volume does not fit the sample's description.
  LayerTail(const SampleFolder& sample, const Volume& volume);

  /// From 1, those of the volume and of the tail together.
  std::int64_t layers_present() const { return end_; }

  /// Whether the chunk holds anything else with the tail than the volume held when it was opened,
  /// or may by now.
  bool touches(int level, ChunkIndex chunk) const;

  /// As Volume::read_chunks, for chunks that the tail touches. Chunks above the same tiles of the
  /// images are made together, from one reading of each tile. At most one file a thread is open; a
  /// thread holds a few tiles of at most 32 layers, or of as many as a voxel is the mean of. A
  /// layer that is missing, damaged or of another size goes to `on_damage` for each chunk of the
  /// block that it belongs to.
  void read_chunks(int level, std::span<const ChunkIndex> wanted, const Volume::OnChunk& on_chunk,
                   const Volume::OnDamage& on_damage = {}) const;

 private:
  class Block;

  /// Layers of a level, from `first` to before `end`.
  struct LayerRange {
    std::int64_t first = 0;
    std::int64_t end = 0;
  };

  LayerRange changed_layers(int level) const;
  cv::Rect face(int level) const;
  int type() const;
  ChunkVoxels empty_chunk() const;
  ChunkVoxels stored_chunk(int level, ChunkIndex index) const;
  cv::Mat layer_of(ChunkVoxels& voxels, std::int64_t layer) const;
  cv::Mat image(std::int64_t layer, const cv::Rect& region) const;
  cv::Mat stored_layer(int level, std::int64_t layer, const cv::Rect& region) const;
  std::vector<cv::Mat> layers(int level, const LayerRange& range, const cv::Rect& region) const;

  SampleFolder sample_;
  const Volume& volume_;
  std::int64_t first_;  // of the tail's layers, from 0: those before are in the volume
  std::int64_t end_;
};

}  // namespace biotomy::reconstruct
