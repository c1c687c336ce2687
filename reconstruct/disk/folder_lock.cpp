#include "reconstruct/disk/folder_lock.hpp"

#include <cerrno>
#include <cstring>
#include <system_error>

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>

#include "reconstruct/disk/durable_file.hpp"
#include "reconstruct/errors.hpp"

namespace biotomy::reconstruct {
namespace {

namespace fs = std::filesystem;

bool is_same_folder(const FileDescriptor& opened, const fs::path& path) {
  struct stat a {};
  struct stat b {};
  return ::fstat(opened.get(), &a) == 0 && ::stat(path.c_str(), &b) == 0 && a.st_ino == b.st_ino &&
         a.st_dev == b.st_dev;
}

}  // namespace

FileDescriptor make_locked_folder(const fs::path& folder, const std::string& taken) {
  for (;;) {
    std::error_code error;
    fs::create_directory(folder, error);
    if (error) {
      throw SampleError(folder.string() + ": cannot create this folder: " + error.message());
    }
    FileDescriptor lock(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
    if (!lock.is_open() && errno == ENOENT) {
      continue;  // whoever had it has finished just now
    }
    if (!lock.is_open()) {
      throw SampleError(folder.string() + ": cannot open it: " + std::strerror(errno));
    }
    if (::flock(lock.get(), LOCK_EX | LOCK_NB) != 0) {
      throw SampleError(taken);
    }
    if (is_same_folder(lock, folder)) {
      sync_folder(folder.parent_path());
      return lock;
    }
  }
}

}  // namespace biotomy::reconstruct
