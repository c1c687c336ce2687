#pragma once

#include <cstdint>
#include <functional>

#include "reconstruct/sample/sample_folder.hpp"
#include "reconstruct/store/pyramid_writer.hpp"
#include "reconstruct/store/volume_layout.hpp"

namespace biotomy::reconstruct {

/// Appends layers to a sample's `volume.ome.zarr`, a band (one shard's depth of layers) at a time,
/// in all levels. Each shard is stored durably; the number of layers in the metadata grows only
/// after all shards of the band are. A band that was interrupted is written anew.
/// What a writer that was killed has left unfinished is removed by the next one.
/// One writer at a time; readers may read at any moment.
class VolumeWriter {
 public:
  /// Creates the store's metadata, or opens the store that is there, which then keeps the layout
  /// that it has. Throws SampleError, and InvalidRequest for a layout that cannot be.
  VolumeWriter(const SampleFolder& sample, const VolumeLayout& layout);

  /// As above, with the volume somewhere else than in the sample's folder.
  VolumeWriter(const SampleFolder& sample, const VolumeLayout& layout,
               const std::filesystem::path& volume);

  int band_depth() const { return array_.layout.shard[0]; }

  /// Layers that are in the volume; a multiple of band_depth() until the job is finished.
  std::int64_t layers_written() const { return layers_written_; }

  /// Layers in front of the band that is written next: a multiple of band_depth(). Fewer than
  /// layers_written() when the last band was incomplete, which is then written anew.
  std::int64_t next_band() const { return layers_written_ / band_depth() * band_depth(); }

  /// Takes back the bands that hold layers behind the first `layers`: they are written anew.
  void take_back_to(std::int64_t layers);

  /// Writes the next band, which has `layer_count` layers: band_depth(), or fewer at the deep end.
  void append_band(std::int64_t layer_count, const BandRegions& band);

  /// Writes every band that layer files 1 to `layers_available` complete (the deepest band of a job
  /// is complete with its last layer), and with `finish` also an incomplete one. A band is read
  /// from the layer files shard by shard, so that memory holds a few shards, whatever the size of a
  /// layer. `progress(layers_written)` is called after each band.
  void append(std::int64_t layers_available, bool finish,
              const std::function<void(std::int64_t)>& progress = {});

 private:
  void create();
  void open();
  void write_group(std::int64_t layers_present) const;

  SampleFolder sample_;
  std::filesystem::path volume_;
  ZarrArray array_;  // of level 0
  std::vector<LevelFactor> factors_;
  std::int64_t layers_written_ = 0;
  bool every_shard_ = false;  // as the group says
};

}  // namespace biotomy::reconstruct
