#include "acquisition/records/sample_lock.hpp"

#include <cerrno>
#include <cstring>
#include <string>

#include <fcntl.h>
#include <sys/file.h>

namespace biotomy::acquisition {

SampleLock::SampleLock(const std::filesystem::path& sample) {
  std::string name = ".";
  name += sample.filename().string();
  name += ".lock";
  const std::filesystem::path path = sample.parent_path() / name;
  file_ = bridge::UniqueFd(::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0644));
  if (!file_.valid()) {
    throw SampleLockError("the lock file " + path.string() +
                          " cannot be made: " + std::strerror(errno) + "; does the folder exist?");
  }
  if (::flock(file_.get(), LOCK_EX | LOCK_NB) != 0) {
    throw SampleLockError("another biotomyd works on the sample " + sample.string() +
                          ": stop it first");
  }
}

}  // namespace biotomy::acquisition
