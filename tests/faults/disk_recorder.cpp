// A library for LD_PRELOAD: what a program does to the files below one folder is written down, with
// all data, in a log beside it. recorded_disk.hpp makes of the log what a disk may hold after a cut
// of the power at any point of it. Programs are not changed for it, and nobody needs to be root.
//
// BIOTOMY_RECORD_FOLDER: what is recorded. BIOTOMY_RECORD_LOG: where to.

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstdarg>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <mutex>
#include <string>
#include <string_view>

#include <dlfcn.h>
#include <fcntl.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/types.h>
#include <sys/uio.h>
#include <unistd.h>

#include "tests/faults/disk_record.hpp"

namespace {

using biotomy::tests::DiskCall;
using biotomy::tests::DiskRecord;

std::string setting(const char* name) {
  const char* value = std::getenv(name);
  return value != nullptr ? value : "";
}

std::string path_of(int descriptor) {
  char path[4096];
  const std::string link = "/proc/self/fd/" + std::to_string(descriptor);
  const ssize_t length = ::readlink(link.c_str(), path, sizeof path);
  return length < 0 ? "" : std::string(path, static_cast<std::size_t>(length));
}

std::uint64_t node_of(int descriptor) {
  struct stat status {};
  return ::fstat(descriptor, &status) == 0 ? status.st_ino : 0;
}

std::uint64_t node_of(const char* path) {
  struct stat status {};
  return ::lstat(path, &status) == 0 ? status.st_ino : 0;
}

class Recorder {
 public:
  Recorder() : folder_(setting("BIOTOMY_RECORD_FOLDER")) {
    const std::string log = setting("BIOTOMY_RECORD_LOG");
    if (folder_.empty() || log.empty()) return;
    log_ = static_cast<int>(::syscall(SYS_openat, AT_FDCWD, log.c_str(),
                                      O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0600));
    if (log_ < 0) std::abort();
    add({.call = DiskCall::start}, {});
  }

  bool holds(std::string_view path) const {
    return log_ >= 0 && path.substr(0, folder_.size()) == folder_ &&
           (path.size() == folder_.size() || path[folder_.size()] == '/');
  }
  bool holds(int descriptor) const { return log_ >= 0 && holds(path_of(descriptor)); }

  /// Every call that changes something is made under it, so that the log has their order.
  std::mutex& order() { return order_; }

  std::uint64_t count() const { return count_; }

  /// To be called under `order`. Paths are written as they are below the folder.
  void add(DiskRecord record, std::string_view path, std::string_view to = {},
           const void* data = nullptr) {
    path = below(path);
    to = below(to);
    timespec now{};
    ::clock_gettime(CLOCK_REALTIME, &now);
    record.time_ns = std::int64_t{1'000'000'000} * now.tv_sec + now.tv_nsec;
    record.path_size = static_cast<std::uint32_t>(path.size());
    record.to_size = static_cast<std::uint32_t>(to.size());
    put(&record, sizeof record);
    put(path.data(), path.size());
    put(to.data(), to.size());
    put(data, record.data_size);
    ++count_;
  }

 private:
  std::string_view below(std::string_view path) const {
    return path.empty() ? path : path.substr(std::min(folder_.size() + 1, path.size()));
  }

  void put(const void* data, std::size_t size) const {
    const char* bytes = static_cast<const char*>(data);
    while (size > 0) {
      const ssize_t count = ::syscall(SYS_write, log_, bytes, size);
      if (count <= 0) std::abort();
      bytes += count;
      size -= static_cast<std::size_t>(count);
    }
  }

  std::string folder_;
  int log_ = -1;
  std::mutex order_;
  std::atomic<std::uint64_t> count_{0};
};

Recorder& recorder() {
  static Recorder instance;
  return instance;
}

template <typename Function>
Function* real(const char* name) {
  return reinterpret_cast<Function*>(::dlsym(RTLD_NEXT, name));
}

template <typename... Folder>
int opened(const char* name, const char* path, int flags, mode_t mode, Folder... folder) {
  auto* function = real<int(Folder..., const char*, int, ...)>(name);
  const bool changes = (flags & (O_CREAT | O_TRUNC)) != 0;
  if (!changes || path == nullptr || !recorder().holds(path)) {
    return function(folder..., path, flags, mode);
  }
  const std::scoped_lock lock(recorder().order());
  const bool existed = node_of(path) != 0;
  const int descriptor = function(folder..., path, flags, mode);
  if (descriptor < 0) return descriptor;
  if (!existed) {
    recorder().add({.call = DiskCall::create, .node = node_of(descriptor)}, path);
  } else if ((flags & O_TRUNC) != 0) {
    recorder().add({.call = DiskCall::truncate, .node = node_of(descriptor)}, path);
  }
  return descriptor;
}

/// `call` gives how many bytes were written. `offset` is where, if the call says so.
template <typename Call>
ssize_t written(int descriptor, const void* bytes, const off64_t* offset, Call call) {
  if (!recorder().holds(descriptor)) return call();
  const std::scoped_lock lock(recorder().order());
  const ssize_t count = call();
  if (count <= 0) return count;
  const off64_t end = offset != nullptr ? *offset + count : ::lseek64(descriptor, 0, SEEK_CUR);
  recorder().add({.call = DiskCall::write,
                  .node = node_of(descriptor),
                  .offset = static_cast<std::uint64_t>(end - count),
                  .data_size = static_cast<std::uint64_t>(count)},
                 path_of(descriptor), {}, bytes);
  return count;
}

/// A sync makes last what was done before it began, once it has ended.
int synced(const char* name, int descriptor) {
  if (!recorder().holds(descriptor)) return real<int(int)>(name)(descriptor);
  std::uint64_t before = 0;
  {
    const std::scoped_lock lock(recorder().order());
    before = recorder().count();
  }
  const int result = real<int(int)>(name)(descriptor);
  const int error = errno;
  {
    const std::scoped_lock lock(recorder().order());
    recorder().add({.call = result == 0 ? DiskCall::sync : DiskCall::failed_sync,
                    .node = node_of(descriptor),
                    .offset = before},
                   path_of(descriptor));
  }
  errno = error;
  return result;
}

/// A call that takes paths and gives 0 when it is done.
template <typename Call>
int moved(DiskCall kind, const char* from, const char* to, Call call) {
  if (from == nullptr || !recorder().holds(from)) return call();
  const std::scoped_lock lock(recorder().order());
  const std::uint64_t node = node_of(from);
  const int result = call();
  if (result != 0) return result;
  const bool is_new = kind == DiskCall::make_folder;
  recorder().add({.call = kind, .node = is_new ? node_of(from) : node}, from,
                 to != nullptr ? to : "");
  return result;
}

/// The calls that no program here makes on recorded files: they would be missing from the log.
void refuse(int descriptor, const char* call) {
  if (!recorder().holds(descriptor)) return;
  std::fprintf(stderr, "disk_recorder: %s on %s is not recorded\n", call,
               path_of(descriptor).c_str());
  std::abort();
}

mode_t mode_of(int flags, va_list arguments) {
  return (flags & O_CREAT) != 0 ? static_cast<mode_t>(va_arg(arguments, int)) : 0;
}

}  // namespace

extern "C" {

int open(const char* path, int flags, ...) {
  va_list arguments;
  va_start(arguments, flags);
  const mode_t mode = mode_of(flags, arguments);
  va_end(arguments);
  return opened("open", path, flags, mode);
}
int open64(const char* path, int flags, ...) {
  va_list arguments;
  va_start(arguments, flags);
  const mode_t mode = mode_of(flags, arguments);
  va_end(arguments);
  return opened("open64", path, flags, mode);
}
int openat(int folder, const char* path, int flags, ...) {
  va_list arguments;
  va_start(arguments, flags);
  const mode_t mode = mode_of(flags, arguments);
  va_end(arguments);
  return opened("openat", path, flags, mode, folder);
}

ssize_t write(int descriptor, const void* bytes, std::size_t count) {
  return written(descriptor, bytes, nullptr, [&] {
    return real<ssize_t(int, const void*, std::size_t)>("write")(descriptor, bytes, count);
  });
}
ssize_t pwrite(int descriptor, const void* bytes, std::size_t count, off_t offset) {
  const off64_t place = offset;
  return written(descriptor, bytes, &place, [&] {
    return real<ssize_t(int, const void*, std::size_t, off_t)>("pwrite")(descriptor, bytes, count,
                                                                         offset);
  });
}
ssize_t pwrite64(int descriptor, const void* bytes, std::size_t count, off64_t offset) {
  return written(descriptor, bytes, &offset, [&] {
    return real<ssize_t(int, const void*, std::size_t, off64_t)>("pwrite64")(descriptor, bytes,
                                                                             count, offset);
  });
}
ssize_t writev(int descriptor, const iovec* parts, int count) {
  refuse(descriptor, "writev");
  return real<ssize_t(int, const iovec*, int)>("writev")(descriptor, parts, count);
}
int fallocate(int descriptor, int mode, off_t offset, off_t length) {
  refuse(descriptor, "fallocate");
  return real<int(int, int, off_t, off_t)>("fallocate")(descriptor, mode, offset, length);
}

int fsync(int descriptor) {
  return synced("fsync", descriptor);
}
int fdatasync(int descriptor) {
  return synced("fdatasync", descriptor);
}

int ftruncate(int descriptor, off_t length) {
  auto* function = real<int(int, off_t)>("ftruncate");
  if (!recorder().holds(descriptor)) return function(descriptor, length);
  const std::scoped_lock lock(recorder().order());
  const int result = function(descriptor, length);
  if (result == 0) {
    recorder().add({.call = DiskCall::truncate,
                    .node = node_of(descriptor),
                    .offset = static_cast<std::uint64_t>(length)},
                   path_of(descriptor));
  }
  return result;
}
int ftruncate64(int descriptor, off64_t length) {
  return ftruncate(descriptor, length);
}

int rename(const char* from, const char* to) {
  return moved(DiskCall::rename, from, to,
               [&] { return real<int(const char*, const char*)>("rename")(from, to); });
}
int unlink(const char* path) {
  return moved(DiskCall::remove, path, nullptr,
               [&] { return real<int(const char*)>("unlink")(path); });
}
int remove(const char* path) {
  return moved(DiskCall::remove, path, nullptr,
               [&] { return real<int(const char*)>("remove")(path); });
}
int mkdir(const char* path, mode_t mode) {
  return moved(DiskCall::make_folder, path, nullptr,
               [&] { return real<int(const char*, mode_t)>("mkdir")(path, mode); });
}

/// For killing_point: from now on no recorded call begins, and none is between its making and its
/// record.
void hold_recorded_disk() {
  recorder().order().lock();
}
}  // extern "C"
