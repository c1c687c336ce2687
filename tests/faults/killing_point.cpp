// A library for LD_PRELOAD: the program is killed at a chosen point of what it does to files and
// sockets. The point is told by the environment (see killing_point.hpp); the program is not changed
// for it.

#include <cstdarg>
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <mutex>
#include <sstream>
#include <string>
#include <vector>

#include <dlfcn.h>
#include <fcntl.h>
#include <fnmatch.h>
#include <signal.h>
#include <sys/socket.h>
#include <sys/types.h>
#include <sys/uio.h>
#include <unistd.h>

namespace {

struct Step {
  std::string when;  // before, amid, after
  std::string call;
  std::string pattern;
  int count = 1;
};

[[noreturn]] void refuse(const std::string& point) {
  std::fprintf(stderr, "killing_point: \"%s\" is no point\n", point.c_str());
  std::abort();
}

std::vector<Step> steps_of(const std::string& point) {
  std::vector<Step> steps;
  std::istringstream text(point);
  for (std::string part; std::getline(text, part, ';');) {
    std::istringstream words(part);
    Step step;
    if (!(words >> step.when >> step.call >> step.pattern)) refuse(point);
    words >> step.count;
    steps.push_back(step);
  }
  return steps;
}

class Point {
 public:
  Point() {
    const char* point = std::getenv("BIOTOMY_KILLING_POINT");
    if (point != nullptr) steps_ = steps_of(point);
  }

  /// A call is about to be made.
  void before(const char* call, const std::string& object) {
    if (reached("before", call, object)) die();
  }
  /// The same of a write; true when only half of it is to be made, and then `die`.
  bool amid(const char* call, const std::string& object) { return reached("amid", call, object); }
  void after(const char* call, const std::string& object) {
    if (reached("after", call, object)) die();
  }

  [[noreturn]] static void die() {
    // A disk_recorder that is there, too, must not be in the middle of a call or of its record.
    if (auto* hold = reinterpret_cast<void (*)()>(::dlsym(RTLD_DEFAULT, "hold_recorded_disk"))) {
      hold();
    }
    for (;;) ::kill(::getpid(), SIGKILL);
  }

  bool is_set() const { return !steps_.empty(); }

 private:
  /// True at the last step.
  bool reached(const char* when, const char* call, const std::string& object) {
    const std::scoped_lock lock(mutex_);
    if (next_ == steps_.size()) return false;
    const Step& step = steps_[next_];
    if (step.when != when || step.call != call ||
        ::fnmatch(step.pattern.c_str(), object.c_str(), 0) != 0 || ++seen_ < step.count) {
      return false;
    }
    seen_ = 0;
    return ++next_ == steps_.size();
  }

  std::vector<Step> steps_;
  std::mutex mutex_;
  std::size_t next_ = 0;
  int seen_ = 0;  // of the next step's calls
};

Point& point() {
  static Point instance;
  return instance;
}

std::string path_of(int descriptor) {
  char path[4096];
  const std::string link = "/proc/self/fd/" + std::to_string(descriptor);
  const ssize_t length = ::readlink(link.c_str(), path, sizeof path);
  return length < 0 ? "" : std::string(path, static_cast<std::size_t>(length));
}

std::string hexadecimal(const void* bytes, std::size_t count) {
  std::string text;
  for (std::size_t i = 0; i < count; ++i) {
    char digits[3];
    std::snprintf(digits, sizeof digits, "%02x", static_cast<const unsigned char*>(bytes)[i]);
    text += digits;
  }
  return text;
}

template <typename Function>
Function* real(const char* name) {
  return reinterpret_cast<Function*>(::dlsym(RTLD_NEXT, name));
}

/// Makes the call with the point's steps around it.
template <typename Make>
auto around(const char* call, const std::string& object, Make make) {
  if (!point().is_set()) return make();
  point().before(call, object);
  const auto result = make();
  point().after(call, object);
  return result;
}

template <typename... Path>
int opened(const char* name, const char* path, int flags, mode_t mode, Path... folder) {
  const auto make = [&] {
    return real<int(Path..., const char*, int, ...)>(name)(folder..., path, flags, mode);
  };
  return (flags & O_CREAT) != 0 ? around("create", path, make) : make();
}

template <typename... Offset>
ssize_t written(const char* name, int descriptor, const void* bytes, std::size_t count,
                Offset... offset) {
  auto* write_out = real<ssize_t(int, const void*, std::size_t, Offset...)>(name);
  const std::string path = path_of(descriptor);
  if (point().amid("write", path)) {
    write_out(descriptor, bytes, count / 2, offset...);
    Point::die();
  }
  return around("write", path, [&] { return write_out(descriptor, bytes, count, offset...); });
}

int synced(const char* name, int descriptor) {
  return around("sync", path_of(descriptor), [&] { return real<int(int)>(name)(descriptor); });
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

ssize_t write(int descriptor, const void* bytes, std::size_t count) {
  return written("write", descriptor, bytes, count);
}
ssize_t pwrite(int descriptor, const void* bytes, std::size_t count, off_t offset) {
  return written("pwrite", descriptor, bytes, count, offset);
}
ssize_t pwrite64(int descriptor, const void* bytes, std::size_t count, off64_t offset) {
  return written("pwrite64", descriptor, bytes, count, offset);
}

ssize_t read(int descriptor, void* bytes, std::size_t count) {
  return around("read", path_of(descriptor), [&] {
    return real<ssize_t(int, void*, std::size_t)>("read")(descriptor, bytes, count);
  });
}

int fsync(int descriptor) {
  return synced("fsync", descriptor);
}
int fdatasync(int descriptor) {
  return synced("fdatasync", descriptor);
}

int rename(const char* from, const char* to) {
  return around("rename", to,
                [&] { return real<int(const char*, const char*)>("rename")(from, to); });
}
int unlink(const char* path) {
  return around("unlink", path, [&] { return real<int(const char*)>("unlink")(path); });
}

ssize_t send(int socket, const void* bytes, std::size_t count, int flags) {
  return around("send", hexadecimal(bytes, count), [&] {
    return real<ssize_t(int, const void*, std::size_t, int)>("send")(socket, bytes, count, flags);
  });
}
ssize_t sendmsg(int socket, const msghdr* message, int flags) {
  const iovec* part = message->msg_iovlen > 0 ? message->msg_iov : nullptr;
  const std::string bytes = part == nullptr ? "" : hexadecimal(part->iov_base, part->iov_len);
  return around("send", bytes, [&] {
    return real<ssize_t(int, const msghdr*, int)>("sendmsg")(socket, message, flags);
  });
}

}  // extern "C"
