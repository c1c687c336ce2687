#include "tools/opened_sample.hpp"

#include "reconstruct/errors.hpp"

namespace biotomy::tools {

using reconstruct::SampleFolder;
using reconstruct::Volume;

OpenedSample::OpenedSample(const std::filesystem::path& path)
    : folder(SampleFolder::open(path)), volume(Volume::of_sample(folder)), tail(folder, volume) {
  if (tail.layers_present() == 0) {
    throw reconstruct::SampleError(path.string() +
                                   ": has no layers yet; a section needs at least one");
  }
}

}  // namespace biotomy::tools
