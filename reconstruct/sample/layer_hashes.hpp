#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace biotomy::reconstruct {

/// What a layer's file must be. `file` is relative to the sample folder.
struct LayerHash {
  std::string file;
  std::string sha256;  ///< lower-case hexadecimal

  friend auto operator<=>(const LayerHash&, const LayerHash&) = default;
};

/// The lines of `layers.sha256`, as sha256sum writes and checks them: `<hash>  layers/000001.tif`.
std::string layer_hash_lines(const std::vector<LayerHash>& hashes);

/// Understands those lines. A last line without its end is one that was cut off as it was written,
/// and does not count. Throws SampleError, naming the file and the line.
std::vector<LayerHash> read_layer_hashes(const std::filesystem::path& path);

/// Likewise, but passes over lines that are none of those.
std::vector<LayerHash> readable_layer_hashes(const std::filesystem::path& path);

}  // namespace biotomy::reconstruct
