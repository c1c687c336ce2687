#include "acquisition/viewer/layer_hashes_file.hpp"

#include "acquisition/viewer/file_version.hpp"
#include "reconstruct/sample/layer_hashes.hpp"

namespace biotomy::acquisition {

std::string LayerHashesFile::sha256(const reconstruct::SampleFolder& sample, std::int64_t layer) {
  const std::string version = file_version(sample.hashes_path());
  const std::string file =
      sample.layer_path(layer).lexically_relative(sample.path()).generic_string();
  const std::lock_guard lock(mutex_);
  if (version != version_) {
    by_file_.clear();
    version_.clear();
    if (!version.empty()) {
      for (const auto& [name, hash] : reconstruct::read_layer_hashes(sample.hashes_path())) {
        by_file_[name] = hash;
      }
    }
    version_ = version;
  }
  const auto found = by_file_.find(file);
  return found == by_file_.end() ? "" : found->second;
}

}  // namespace biotomy::acquisition
