#include "reconstruct/disk/sha256.hpp"

#include <cerrno>
#include <cstring>
#include <vector>

#include <fcntl.h>
#include <unistd.h>

#include "reconstruct/disk/file_descriptor.hpp"
#include "reconstruct/disk/sha256_hash.hpp"
#include "reconstruct/errors.hpp"

namespace biotomy::reconstruct {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kReadBlock = std::size_t{1} << 20;

[[noreturn]] void fail(const fs::path& path, const std::string& what, int error) {
  throw SampleError(path.string() + ": cannot " + what + ": " + std::strerror(error));
}

}  // namespace

std::string sha256(std::span<const std::byte> bytes) {
  Sha256Hash hash;
  hash.add(bytes);
  return hash.finish();
}

std::string sha256_of_file(const fs::path& path) {
  const FileDescriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC));
  if (!file.is_open()) {
    fail(path, "open it", errno);
  }
  Sha256Hash hash;
  std::vector<std::byte> block(kReadBlock);
  for (;;) {
    const ssize_t count = ::read(file.get(), block.data(), block.size());
    if (count < 0 && errno == EINTR) {
      continue;
    }
    if (count < 0) {
      fail(path, "read it", errno);
    }
    if (count == 0) {
      return hash.finish();
    }
    hash.add({block.data(), static_cast<std::size_t>(count)});
  }
}

}  // namespace biotomy::reconstruct
