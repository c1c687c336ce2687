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
#include "reconstruct/store/file_descriptor.hpp"

namespace biotomy::reconstruct {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail(const fs::path& path, const std::string& what) {
  throw SampleError(path.string() + ": " + what);
}

std::vector<std::byte> read_whole(const FileDescriptor& file, const fs::path& path) {
  struct stat status {};
  if (::fstat(file.get(), &status) != 0) {
    fail(path, std::string("cannot look at it: ") + std::strerror(errno));
  }
  std::vector<std::byte> bytes(static_cast<std::size_t>(status.st_size));
  std::span<std::byte> left(bytes);
  while (!left.empty()) {
    const ssize_t count = ::read(file.get(), left.data(), left.size());
    if (count < 0 && errno == EINTR) {
      continue;
    }
    if (count <= 0) {
      fail(path, count < 0 ? std::string("cannot read it: ") + std::strerror(errno)
                           : std::string("became shorter while it was read"));
    }
    left = left.subspan(static_cast<std::size_t>(count));
  }
  return bytes;
}

}  // namespace

StoredShard::StoredShard(fs::path path, const BlockCount& chunks)
    : path_(std::move(path)), chunks_(chunks) {}

std::optional<StoredShard> StoredShard::read(const fs::path& path, const BlockCount& chunks) {
  const FileDescriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC));
  if (!file.is_open()) {
    if (errno == ENOENT) {
      return std::nullopt;
    }
    fail(path, std::string("cannot open it: ") + std::strerror(errno));
  }
  StoredShard shard(path, chunks);
  shard.bytes_ = read_whole(file, path);
  const std::size_t index_bytes = shard_index_bytes(static_cast<std::size_t>(chunks.total()));
  if (shard.bytes_.size() < index_bytes) {
    fail(path, "is truncated: it is shorter than its index");
  }
  try {
    shard.index_ =
        parse_shard_index(std::span(shard.bytes_).last(index_bytes), shard.bytes_.size());
  } catch (const SampleError& error) {
    fail(path, std::string("is damaged: ") + error.what());
  }
  return shard;
}

std::span<const std::byte> StoredShard::encoded(std::size_t chunk) const {
  const ChunkRange& range = index_.at(chunk);
  if (!range.stored()) {
    return {};
  }
  return std::span(bytes_).subspan(range.offset, range.length);
}

void StoredShard::decode(std::size_t chunk, const ChunkCodec& codec,
                         std::span<std::byte> voxels) const {
  if (!index_.at(chunk).stored()) {
    std::fill(voxels.begin(), voxels.end(), std::byte{0});
    return;
  }
  try {
    codec.decode(encoded(chunk), voxels);
  } catch (const SampleError& error) {
    const auto place = static_cast<std::int64_t>(chunk);
    fail(path_, "its chunk z " + std::to_string(place / (chunks_.x * chunks_.y)) + ", y " +
                    std::to_string(place / chunks_.x % chunks_.y) + ", x " +
                    std::to_string(place % chunks_.x) + " is damaged: " + error.what());
  }
}

}  // namespace biotomy::reconstruct
