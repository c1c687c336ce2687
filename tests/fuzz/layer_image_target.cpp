#include <algorithm>
#include <string>

#include <opencv2/core.hpp>
#include <sys/mman.h>
#include <unistd.h>

#include "reconstruct/disk/file_descriptor.hpp"
#include "reconstruct/sample/layer_image.hpp"
#include "tests/fuzz/fuzz_targets.hpp"
#include "tests/fuzz/refusal.hpp"

namespace biotomy::tests {

bool fuzz_layer_image(FuzzInput input) {
  const reconstruct::FileDescriptor file(::memfd_create("layer", MFD_CLOEXEC));
  require(file.is_open() &&
              ::write(file.get(), input.data(), input.size()) == static_cast<ssize_t>(input.size()),
          "cannot make a file in memory");
  const std::string path = "/proc/self/fd/" + std::to_string(file.get());
  return accepts(path, [&] {
    reconstruct::LayerImageReader reader(path);
    const int width = std::min(reader.width(), 40);
    const int height = std::min(reader.height(), 40);
    reader.read({0, 0, width, height});
    reader.read({reader.width() - width, reader.height() - height, width, height});
  });
}

}  // namespace biotomy::tests
