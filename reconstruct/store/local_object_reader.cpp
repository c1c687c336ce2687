#include "reconstruct/store/local_object_reader.hpp"

#include <cerrno>
#include <cstring>
#include <utility>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include "reconstruct/errors.hpp"

namespace biotomy::reconstruct {
namespace {

/// Shards are never written in place, so a new content is a new file: another inode or, should the
/// number be used again, another time.
ObjectVersion version_of(const struct stat& status) {
  return {static_cast<std::uint64_t>(status.st_size),
          std::to_string(status.st_ino) + "-" + std::to_string(status.st_mtim.tv_sec) + "." +
              std::to_string(status.st_mtim.tv_nsec)};
}

[[noreturn]] void fail(const std::string& where, const std::string& what, int error) {
  throw SampleError(where + ": cannot " + what + ": " + std::strerror(error));
}

}  // namespace

LocalObjectReader::LocalObjectReader(std::filesystem::path root, std::size_t most_open)
    : root_(std::move(root)), open_files_(most_open) {}

std::string LocalObjectReader::describe(const std::string& name) const {
  return (root_ / name).string();
}

std::optional<ObjectVersion> LocalObjectReader::version(const std::string& name) {
  struct stat status {};
  if (::stat((root_ / name).c_str(), &status) != 0) {
    if (errno == ENOENT || errno == ENOTDIR) {
      return std::nullopt;
    }
    fail(describe(name), "look for it", errno);
  }
  if (!S_ISREG(status.st_mode)) {
    throw SampleError(describe(name) + ": is not a file");  // a pipe would let us wait for ever
  }
  return version_of(status);
}

std::shared_ptr<const LocalObjectReader::OpenFile> LocalObjectReader::open(
    const std::string& name, const ObjectVersion& version) {
  {
    const std::lock_guard lock(mutex_);
    const auto* found = open_files_.find(name);
    if (found != nullptr && (*found)->version == version) {
      return *found;
    }
  }
  FileDescriptor descriptor(::open((root_ / name).c_str(), O_RDONLY | O_CLOEXEC));
  if (!descriptor.is_open()) {
    fail(describe(name), "open it", errno);
  }
  struct stat status {};
  if (::fstat(descriptor.get(), &status) != 0) {
    fail(describe(name), "look at it", errno);
  }
  if (version_of(status) != version) {
    throw ObjectReplaced(describe(name) + ": was replaced while it was being read");
  }
  auto file = std::make_shared<const OpenFile>(OpenFile{std::move(descriptor), version});
  const std::lock_guard lock(mutex_);
  open_files_.put(name, file, 1);
  return file;
}

void LocalObjectReader::read(const std::string& name, const ObjectVersion& version,
                             std::uint64_t offset, std::span<std::byte> out) {
  const auto file = open(name, version);
  while (!out.empty()) {
    const ssize_t count =
        ::pread(file->descriptor.get(), out.data(), out.size(), static_cast<off_t>(offset));
    if (count < 0 && errno == EINTR) {
      continue;
    }
    if (count < 0) {
      fail(describe(name), "read it", errno);
    }
    if (count == 0) {
      throw SampleError(describe(name) + ": is truncated; nothing at byte " +
                        std::to_string(offset));
    }
    out = out.subspan(static_cast<std::size_t>(count));
    offset += static_cast<std::uint64_t>(count);
  }
}

// The kernel reads ahead into its page cache without making anybody wait.
void LocalObjectReader::expect(const std::string& name, const ObjectVersion& version,
                               std::uint64_t offset, std::uint64_t length) {
  try {
    const auto file = open(name, version);
    ::posix_fadvise(file->descriptor.get(), static_cast<off_t>(offset), static_cast<off_t>(length),
                    POSIX_FADV_WILLNEED);
  } catch (const std::runtime_error&) {
    return;  // the reading will say it
  }
}

}  // namespace biotomy::reconstruct
