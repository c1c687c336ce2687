#include "reconstruct/store/stored_shard.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <string>
#include <utility>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include "reconstruct/errors.hpp"

namespace biotomy::reconstruct {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail(const fs::path& path, const std::string& what) {
  throw SampleError(path.string() + ": " + what);
}

}  // namespace

StoredShard::StoredShard(fs::path path, const BlockCount& chunks, FileDescriptor file)
    : path_(std::move(path)), chunks_(chunks), file_(std::move(file)) {}

std::optional<StoredShard> StoredShard::open(const fs::path& path, const ZarrArray& array) {
  // Not blocking: whoever puts a pipe in a shard's place must not stop us.
  FileDescriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));
  if (!file.is_open()) {
    if (errno == ENOENT) {
      return std::nullopt;
    }
    fail(path, std::string("cannot open it: ") + std::strerror(errno));
  }
  StoredShard shard(path, chunks_of_shard(array.layout), std::move(file));
  const std::uint64_t size = shard.size();
  const std::size_t index_bytes =
      shard_index_bytes(static_cast<std::size_t>(shard.chunks_.total()));
  if (size < index_bytes) {
    fail(path, "is truncated: it is shorter than its index");
  }
  std::vector<std::byte> index(index_bytes);
  shard.read(size - index_bytes, index);
  try {
    shard.index_ =
        parse_shard_index(index, size, ChunkCodec(array.layout, array.bits).longest_encoded());
  } catch (const SampleError& error) {
    fail(path, std::string("is damaged: ") + error.what());
  }
  return shard;
}

std::uint64_t StoredShard::size() const {
  struct stat status {};
  if (::fstat(file_.get(), &status) != 0) {
    fail(path_, std::string("cannot look at it: ") + std::strerror(errno));
  }
  if (!S_ISREG(status.st_mode)) {
    fail(path_, "is not a file");
  }
  return static_cast<std::uint64_t>(status.st_size);
}

void StoredShard::read(std::uint64_t offset, std::span<std::byte> out) const {
  while (!out.empty()) {
    const ssize_t count = ::pread(file_.get(), out.data(), out.size(), static_cast<off_t>(offset));
    if (count < 0 && errno == EINTR) {
      continue;
    }
    if (count <= 0) {
      fail(path_, count < 0 ? std::string("cannot read it: ") + std::strerror(errno)
                            : std::string("became shorter while it was read"));
    }
    out = out.subspan(static_cast<std::size_t>(count));
    offset += static_cast<std::uint64_t>(count);
  }
}

std::vector<std::byte> StoredShard::encoded(std::size_t chunk) const {
  const ChunkRange& range = index_.at(chunk);
  std::vector<std::byte> bytes(range.stored() ? range.length : 0);
  read(range.offset, bytes);
  return bytes;
}

void StoredShard::decode(std::size_t chunk, const ChunkCodec& codec,
                         std::span<std::byte> voxels) const {
  if (!stores(chunk)) {
    std::fill(voxels.begin(), voxels.end(), std::byte{0});
    return;
  }
  const std::vector<std::byte> bytes = encoded(chunk);
  try {
    codec.decode(bytes, voxels);
  } catch (const SampleError& error) {
    const auto place = static_cast<std::int64_t>(chunk);
    fail(path_, "its chunk z " + std::to_string(place / (chunks_.x * chunks_.y)) + ", y " +
                    std::to_string(place / chunks_.x % chunks_.y) + ", x " +
                    std::to_string(place % chunks_.x) + " is damaged: " + error.what());
  }
}

}  // namespace biotomy::reconstruct
