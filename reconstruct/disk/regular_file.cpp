#include "reconstruct/disk/regular_file.hpp"

#include <cerrno>
#include <cstring>

#include <fcntl.h>
#include <sys/stat.h>

#include "reconstruct/errors.hpp"

namespace biotomy::reconstruct {

FileDescriptor open_regular_file(const std::filesystem::path& path) {
  // Not blocking: a pipe is told for one only once it is open.
  FileDescriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));
  struct stat status {};
  if (!file.is_open() || ::fstat(file.get(), &status) != 0) {
    throw SampleError(path.string() + ": cannot open it: " + std::strerror(errno));
  }
  if (!S_ISREG(status.st_mode)) {
    throw SampleError(path.string() + ": is not a regular file");
  }
  return file;
}

}  // namespace biotomy::reconstruct
