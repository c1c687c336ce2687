#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>

#include "reconstruct/sample/sample_folder.hpp"
#include "reconstruct/store/volume_layout.hpp"

namespace biotomy::reconstruct {

/// Appends layers to a sample's `volume.ome.zarr`, a band (one shard's depth of layers) at a time.
/// A band is read from the layer files shard by shard, so that memory holds a few shards, whatever
/// the size of a layer. Each shard is stored durably; the number of layers in the metadata grows
/// only after all shards of the band are. A band that was interrupted is written anew.
/// One writer at a time; readers may read at any moment.
class VolumeWriter {
 public:
  /// Creates the store's metadata, or opens the store that is there, which then keeps the layout
  /// that it has. Throws SampleError, and InvalidRequest for a layout that cannot be.
  VolumeWriter(const SampleFolder& sample, const VolumeLayout& layout);

  int band_depth() const { return layout_.shard[0]; }

  /// Layers that are in the volume; a multiple of band_depth() until the job is finished.
  std::int64_t layers_written() const { return layers_written_; }

  /// Writes every band that layer files 1 to `layers_available` complete (the deepest band of a job
  /// is complete with its last layer), and with `finish` also an incomplete one.
  /// `progress(layers_written)` is called after each band.
  void append(std::int64_t layers_available, bool finish,
              const std::function<void(std::int64_t)>& progress = {});

 private:
  void write_band(std::int64_t first_layer, std::int64_t layer_count);

  SampleFolder sample_;
  VolumeLayout layout_;
  std::int64_t layers_written_ = 0;
};

}  // namespace biotomy::reconstruct
