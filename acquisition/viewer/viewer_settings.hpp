#pragma once

#include <cstddef>
#include <string>

namespace biotomy::acquisition {

/// How much of the computer looking at a sample may take, and who may.
struct ViewerSettings {
  std::size_t cache_bytes = 256'000'000;  ///< of decoded chunks, at most
  int threads = 0;                        ///< that sample one section; 0: half of the processors
  std::string neuroglancer = {};          ///< the one origin that may read the volume; empty: none
};

}  // namespace biotomy::acquisition
