#include "reconstruct/disk/sha256.hpp"

#include <cerrno>
#include <cstring>
#include <vector>

#include <unistd.h>

#include "reconstruct/disk/regular_file.hpp"
#include "reconstruct/disk/sha256_hash.hpp"
#include "reconstruct/errors.hpp"

namespace biotomy::reconstruct {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kReadBlock = std::size_t{1} << 20;

}  // namespace

std::string sha256(std::span<const std::byte> bytes) {
  Sha256Hash hash;
  hash.add(bytes);
  return hash.finish();
}

std::string sha256_of_file(const fs::path& path) {
  const FileDescriptor file = open_regular_file(path);
  Sha256Hash hash;
  std::vector<std::byte> block(kReadBlock);
  for (;;) {
    const ssize_t count = ::read(file.get(), block.data(), block.size());
    if (count < 0 && errno == EINTR) {
      continue;
    }
    if (count < 0) {
      throw SampleError(path.string() + ": cannot read it: " + std::strerror(errno));
    }
    if (count == 0) {
      return hash.finish();
    }
    hash.add({block.data(), static_cast<std::size_t>(count)});
  }
}

}  // namespace biotomy::reconstruct
