// A library for LD_PRELOAD: calls on files below one folder fail as they do on a disk that is full,
// broken or read-only. What fails, and when, is told by the environment (see fault.hpp). Programs
// are not changed for it, and nobody needs to be root. The disk is one for a program and those that
// it starts: they count their calls and bytes together.

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstdarg>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <new>
#include <string>

#include <dlfcn.h>
#include <fcntl.h>
#include <sys/mman.h>
#include <sys/statvfs.h>
#include <sys/syscall.h>
#include <sys/types.h>
#include <sys/uio.h>
#include <unistd.h>

namespace {

enum Call { kCreate, kMkdir, kRead, kWrite, kSync, kRename, kCalls };
constexpr const char* kNames[kCalls] = {"create", "mkdir", "read", "write", "sync", "rename"};

const char* setting(const char* name) {
  const char* value = std::getenv(name);
  return value != nullptr ? value : "";
}

std::int64_t number(const char* name) {
  return std::strtoll(setting(name), nullptr, 10);
}

int error_number(const std::string& name) {
  return name == "ENOSPC" ? ENOSPC : name == "EROFS" ? EROFS : EIO;
}

/// What has happened to the disk, of all processes.
struct Counts {
  std::atomic<std::int64_t> calls[kCalls]{};
  std::atomic<std::int64_t> numbered[kCalls]{};  ///< those that may fail by their number
  std::atomic<std::int64_t> written{0};
};
static_assert(std::atomic<std::int64_t>::is_always_lock_free);

/// Memory that the first process makes and the others find through it, as it outlives them.
Counts& shared_counts() {
  constexpr const char* kPlace = "BIOTOMY_FAULT_SHARED";
  const bool is_first = *setting(kPlace) == '\0';
  const int file =
      is_first
          ? ::memfd_create("faulty disk", MFD_CLOEXEC)
          : static_cast<int>(::syscall(SYS_openat, AT_FDCWD, setting(kPlace), O_RDWR | O_CLOEXEC));
  if (file < 0 || (is_first && ::syscall(SYS_ftruncate, file, sizeof(Counts)) != 0)) std::abort();
  void* memory = ::mmap(nullptr, sizeof(Counts), PROT_READ | PROT_WRITE, MAP_SHARED, file, 0);
  if (memory == MAP_FAILED) std::abort();
  if (!is_first) {
    ::close(file);
    return *static_cast<Counts*>(memory);
  }
  const std::string place = "/proc/" + std::to_string(::getpid()) + "/fd/" + std::to_string(file);
  ::setenv(kPlace, place.c_str(), 1);
  return *new (memory) Counts;
}

class FaultyDisk {
 public:
  FaultyDisk()
      : folder_(setting("BIOTOMY_FAULT_FOLDER")),
        call_(setting("BIOTOMY_FAULT_CALL")),
        error_(error_number(setting("BIOTOMY_FAULT_ERROR"))),
        first_(number("BIOTOMY_FAULT_AT")),
        times_(number("BIOTOMY_FAULT_TIMES")),
        after_renames_(number("BIOTOMY_FAULT_AFTER_RENAMES")),
        space_(number("BIOTOMY_FAULT_SPACE")),
        most_bytes_(number("BIOTOMY_FAULT_MOST_BYTES")),
        cannot_exchange_(number("BIOTOMY_FAULT_CANNOT_EXCHANGE") != 0),
        healed_by_(setting("BIOTOMY_FAULT_HEALED_BY")) {}

  ~FaultyDisk() {
    const char* path = setting("BIOTOMY_FAULT_COUNTS");
    if (std::FILE* file = *path != '\0' ? std::fopen(path, "w") : nullptr; file != nullptr) {
      for (int call = 0; call < kCalls; ++call) {
        std::fprintf(file, "%s %lld\n", kNames[call], static_cast<long long>(counts_.calls[call]));
      }
      std::fclose(file);
    }
  }

  bool holds(const char* path) const {
    return !folder_.empty() && path != nullptr &&
           std::strncmp(path, folder_.c_str(), folder_.size()) == 0;
  }
  bool holds(int descriptor) const {
    char path[4096];
    const std::string link = "/proc/self/fd/" + std::to_string(descriptor);
    const ssize_t length = ::readlink(link.c_str(), path, sizeof path - 1);
    if (length < 0) return false;
    path[length] = '\0';
    return holds(path);
  }

  /// Counts the call; from the chosen one on it fails, with errno set.
  bool fails(Call call) {
    const bool is_numbered = counts_.calls[kRename] >= after_renames_;
    ++counts_.calls[call];
    if (!is_numbered) return false;
    const std::int64_t count = ++counts_.numbered[call];
    const bool failing = first_ > 0 && call_ == kNames[call] && count >= first_ &&
                         (times_ == 0 || count < first_ + times_) && !is_healed();
    if (failing) errno = error_;
    return failing;
  }

  /// How many of `bytes` can be written now; −1, with errno set, when nothing fits any more.
  ssize_t room_for(std::size_t bytes) {
    if (fails(kWrite)) return -1;
    auto room = static_cast<std::int64_t>(at_most(bytes));
    if (space_ > 0 && !is_healed()) {
      const std::int64_t before = counts_.written.fetch_add(room);
      room = before + room <= space_ ? room : space_ - before;
      if (room <= 0) {
        errno = error_;
        return -1;
      }
    }
    return room;
  }

  bool cannot_exchange() const { return cannot_exchange_; }

  bool is_full_disk() const { return space_ > 0 && !is_healed(); }

  /// Bytes that can still be written; for a full disk only.
  std::int64_t space_left() const {
    return std::max<std::int64_t>(space_ - counts_.written.load(), 0);
  }

  std::size_t at_most(std::size_t bytes) const {
    const auto most = static_cast<std::size_t>(most_bytes_);
    return most_bytes_ > 0 && bytes > most ? most : bytes;
  }

 private:
  bool is_healed() const {
    return !healed_by_.empty() && ::syscall(SYS_faccessat, AT_FDCWD, healed_by_.c_str(), F_OK) == 0;
  }

  std::string folder_;
  std::string call_;
  int error_;
  std::int64_t first_;
  std::int64_t times_;
  std::int64_t after_renames_;
  std::int64_t space_;
  std::int64_t most_bytes_;
  bool cannot_exchange_;
  std::string healed_by_;
  Counts& counts_ = shared_counts();
};

FaultyDisk& disk() {
  static FaultyDisk instance;
  return instance;
}

// Before there are threads, as the environment is changed.
[[gnu::constructor]] void make_disk() {
  disk();
}

template <typename Function>
Function* real(const char* name) {
  return reinterpret_cast<Function*>(::dlsym(RTLD_NEXT, name));
}

template <typename... Path>
int opened(const char* name, const char* path, int flags, mode_t mode, Path... folder) {
  if ((flags & O_CREAT) != 0 && disk().holds(path) && disk().fails(kCreate)) return -1;
  return real<int(Path..., const char*, int, ...)>(name)(folder..., path, flags, mode);
}

template <typename... Offset>
ssize_t written(const char* name, int descriptor, const void* bytes, std::size_t count,
                Offset... offset) {
  if (disk().holds(descriptor)) {
    const ssize_t room = disk().room_for(count);
    if (room < 0) return -1;
    count = static_cast<std::size_t>(room);
  }
  return real<ssize_t(int, const void*, std::size_t, Offset...)>(name)(descriptor, bytes, count,
                                                                       offset...);
}

template <typename... Offset>
ssize_t was_read(const char* name, int descriptor, void* bytes, std::size_t count,
                 Offset... offset) {
  if (disk().holds(descriptor)) {
    if (disk().fails(kRead)) return -1;
    count = disk().at_most(count);
  }
  return real<ssize_t(int, void*, std::size_t, Offset...)>(name)(descriptor, bytes, count,
                                                                 offset...);
}

int synced(const char* name, int descriptor) {
  if (disk().holds(descriptor) && disk().fails(kSync)) return -1;
  return real<int(int)>(name)(descriptor);
}

template <typename Status>
int asked_for_space(const char* name, const char* path, Status* status) {
  const int result = real<int(const char*, Status*)>(name)(path, status);
  if (result == 0 && disk().holds(path) && disk().is_full_disk()) {
    status->f_bavail = static_cast<std::uint64_t>(disk().space_left()) / status->f_frsize;
    status->f_bfree = status->f_bavail;
  }
  return result;
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
  return written("write", descriptor, bytes, count);
}
ssize_t pwrite(int descriptor, const void* bytes, std::size_t count, off_t offset) {
  return written("pwrite", descriptor, bytes, count, offset);
}
ssize_t pwrite64(int descriptor, const void* bytes, std::size_t count, off64_t offset) {
  return written("pwrite64", descriptor, bytes, count, offset);
}
ssize_t writev(int descriptor, const iovec* parts, int count) {
  if (disk().holds(descriptor) && count > 0) {  // the first part alone: a short write
    return written("write", descriptor, parts[0].iov_base, parts[0].iov_len);
  }
  return real<ssize_t(int, const iovec*, int)>("writev")(descriptor, parts, count);
}

ssize_t read(int descriptor, void* bytes, std::size_t count) {
  return was_read("read", descriptor, bytes, count);
}
ssize_t pread(int descriptor, void* bytes, std::size_t count, off_t offset) {
  return was_read("pread", descriptor, bytes, count, offset);
}
ssize_t pread64(int descriptor, void* bytes, std::size_t count, off64_t offset) {
  return was_read("pread64", descriptor, bytes, count, offset);
}

int fsync(int descriptor) {
  return synced("fsync", descriptor);
}
int fdatasync(int descriptor) {
  return synced("fdatasync", descriptor);
}

int ftruncate(int descriptor, off_t length) {
  if (disk().holds(descriptor) && disk().room_for(1) < 0) return -1;
  return real<int(int, off_t)>("ftruncate")(descriptor, length);
}
int fallocate(int descriptor, int mode, off_t offset, off_t length) {
  if (disk().holds(descriptor) && disk().room_for(static_cast<std::size_t>(length)) < 0) return -1;
  return real<int(int, int, off_t, off_t)>("fallocate")(descriptor, mode, offset, length);
}
int posix_fallocate(int descriptor, off_t offset, off_t length) {
  if (disk().holds(descriptor) && disk().room_for(static_cast<std::size_t>(length)) < 0) {
    return errno;
  }
  return real<int(int, off_t, off_t)>("posix_fallocate")(descriptor, offset, length);
}

int rename(const char* from, const char* to) {
  if (disk().holds(to) && disk().fails(kRename)) return -1;
  return real<int(const char*, const char*)>("rename")(from, to);
}
int renameat2(int from_folder, const char* from, int to_folder, const char* to,
              unsigned int flags) {
  if (disk().holds(to) && (flags & RENAME_EXCHANGE) != 0 && disk().cannot_exchange()) {
    errno = EINVAL;
    return -1;
  }
  if (disk().holds(to) && disk().fails(kRename)) return -1;
  return real<int(int, const char*, int, const char*, unsigned int)>("renameat2")(
      from_folder, from, to_folder, to, flags);
}
int statvfs(const char* path, struct statvfs* status) {
  return asked_for_space("statvfs", path, status);
}
int statvfs64(const char* path, struct statvfs64* status) {
  return asked_for_space("statvfs64", path, status);
}
int mkdir(const char* path, mode_t mode) {
  if (disk().holds(path) && disk().fails(kMkdir)) return -1;
  return real<int(const char*, mode_t)>("mkdir")(path, mode);
}

}  // extern "C"
