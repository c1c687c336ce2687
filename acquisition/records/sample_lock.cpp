#include "acquisition/records/sample_lock.hpp"

#include <cerrno>
#include <cstring>
#include <string>

#include <fcntl.h>
#include <sys/file.h>

#include "reconstruct/absolute_folder.hpp"

namespace biotomy::acquisition {

namespace {

/// By whatever name the sample is called, also by a symbolic link's, it is one file.
std::filesystem::path lock_file_of(const std::filesystem::path& called) {
  std::error_code error;
  std::filesystem::path sample =
      std::filesystem::weakly_canonical(reconstruct::absolute_folder(called), error);
  if (error) sample = reconstruct::absolute_folder(called);
  std::string name = ".";
  name += sample.filename().string();
  name += ".lock";
  return sample.parent_path() / name;
}

}  // namespace

SampleLock::SampleLock(const std::filesystem::path& sample) {
  const std::filesystem::path path = lock_file_of(sample);
  file_ = bridge::UniqueFd(::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0644));
  if (!file_.valid()) {
    throw SampleLockError("the lock file " + path.string() +
                          " cannot be made: " + std::strerror(errno) + "; does the folder exist?");
  }
  if (::flock(file_.get(), LOCK_EX | LOCK_NB) != 0) {
    throw SampleLockError("another biotomyd works on the sample " + sample.string() +
                          ", or biotomy rebuild: stop it, or wait for its end");
  }
}

bool SampleLock::is_held(const std::filesystem::path& sample) {
  const bridge::UniqueFd file(::open(lock_file_of(sample).c_str(), O_RDONLY | O_CLOEXEC));
  return file.valid() && ::flock(file.get(), LOCK_SH | LOCK_NB) != 0 && errno == EWOULDBLOCK;
}

}  // namespace biotomy::acquisition
