#include "reconstruct/bricks/opened_sample.hpp"

#include "reconstruct/errors.hpp"

namespace biotomy::reconstruct {

OpenedSample::OpenedSample(const std::filesystem::path& path)
    : folder(SampleFolder::open(path)), volume(Volume::of_sample(folder)), tail(folder, volume) {}

void OpenedSample::require_layers() const {
  if (tail.layers_present() == 0) {
    throw SampleError(folder.path().string() + ": has no layers yet; a section needs at least one");
  }
}

}  // namespace biotomy::reconstruct
