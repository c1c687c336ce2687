#pragma once

#include <map>
#include <memory>
#include <mutex>
#include <string>

#include "reconstruct/sample/sample_folder.hpp"

namespace biotomy::acquisition {

/// The hashes of an imported sample's layers, read again only when their file is another. Safe for
/// many threads.
class LayerHashesFile {
 public:
  /// Of a section number; empty where the sample has none.
  std::string sha256(const reconstruct::SampleFolder& sample, std::int64_t layer);

 private:
  std::mutex mutex_;
  std::string version_;
  std::map<std::string, std::string> by_file_;  // relative to the sample
};

}  // namespace biotomy::acquisition
