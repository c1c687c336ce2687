#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "reconstruct/geometry/cuboid.hpp"

namespace biotomy::reconstruct {

/// What `sample.toml` says of a sample. Written once, when the sample is begun.
struct SampleDescription {
  std::string name;
  Cuboid cuboid;  ///< of the whole job; layers may still be missing at its deep end
  int bits = 8;   ///< of one colour, 8 or 16
  std::string notes;
  std::string created;  ///< ISO 8601, UTC
  /// Section numbers, from 1, in order: of these there is no photograph, and they are the layer
  /// before them once more.
  std::vector<std::int64_t> repeated_layers = {};
};

/// A sample on disk: the folder and the names of what lies in it.
class SampleFolder {
 public:
  // For those who look before there is a sample to open, or while it grows.
  static constexpr const char* kDescriptionName = "sample.toml";
  static constexpr const char* kVolumeName = "volume.ome.zarr";
  static constexpr const char* kJournalName = "journal.sqlite";

  /// Whether a sample can be begun at `path`: there is nothing, an empty folder, or what `create`
  /// leaves when it is killed, which has no image and no description in it yet.
  static bool can_begin(const std::filesystem::path& path);

  /// Makes the folder with `sample.toml`, which comes last, and the empty folders in it, durably.
  /// Throws SampleError, also when a sample cannot begin there.
  static SampleFolder create(const std::filesystem::path& path,
                             const SampleDescription& description);

  /// Throws SampleError when it is not a sample or sample.toml does not make sense.
  static SampleFolder open(const std::filesystem::path& path);

  const std::filesystem::path& path() const { return path_; }
  const SampleDescription& description() const { return description_; }

  /// The image of a section number, from 1: `layers/000001.tif`.
  std::filesystem::path layer_path(std::int64_t layer) const;

  /// How many layer images follow each other without a gap, the first of section number `first`.
  std::int64_t layers_on_disk(std::int64_t first) const;

  std::filesystem::path volume_path() const;
  std::filesystem::path journal_path() const;
  /// The hashes of an imported sample's layers, `layers.sha256`.
  std::filesystem::path hashes_path() const;
  std::filesystem::path rejected_path() const;

 private:
  SampleFolder(std::filesystem::path path, SampleDescription description);

  std::filesystem::path path_;
  SampleDescription description_;
};

}  // namespace biotomy::reconstruct
