#include <algorithm>
#include <cstddef>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string>

#include "tests/kernel/frame_source.hpp"

namespace biotomy::tests {

namespace {

class FolderFrames final : public FrameSource {
 public:
  explicit FolderFrames(std::filesystem::path folder) : folder_(std::move(folder)) {}

  std::vector<std::uint8_t> next(const FrameSize& size) override {
    const auto sized = folder_ / (std::to_string(size.width) + "x" + std::to_string(size.height));
    std::vector<std::filesystem::path> files;
    for (const auto& entry : std::filesystem::directory_iterator(sized)) {
      files.push_back(entry.path());
    }
    if (files.empty()) throw std::runtime_error(sized.string() + " is empty");
    std::sort(files.begin(), files.end());
    std::ifstream file(files[taken_++ % files.size()], std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
  }

 private:
  std::filesystem::path folder_;
  std::size_t taken_ = 0;
};

}  // namespace

std::unique_ptr<FrameSource> frames_of_folder(const std::filesystem::path& folder) {
  return std::make_unique<FolderFrames>(folder);
}

}  // namespace biotomy::tests
