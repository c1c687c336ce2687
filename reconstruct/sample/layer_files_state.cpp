#include "reconstruct/sample/layer_files_state.hpp"

#include <span>
#include <sstream>

#include <sys/stat.h>

#include "reconstruct/disk/sha256.hpp"

namespace biotomy::reconstruct {

std::string layer_files_state(const SampleFolder& sample, std::int64_t layers) {
  std::ostringstream lines;
  for (std::int64_t layer = 1; layer <= layers; ++layer) {
    struct stat status {};
    if (::stat(sample.layer_path(layer).c_str(), &status) == 0) {
      lines << layer << ' ' << status.st_size << ' ' << status.st_mtim.tv_sec << ' '
            << status.st_mtim.tv_nsec << '\n';
    }
  }
  const std::string text = lines.str();
  return sha256(std::as_bytes(std::span(text)));
}

}  // namespace biotomy::reconstruct
