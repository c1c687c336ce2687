#include "acquisition/records/sample_lock.hpp"

#include <cerrno>
#include <cstring>
#include <string>

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

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

/// A lock file that root makes, perhaps with a umask that closes it to others, is the owner's of
/// the sample. Without that the lock holds all the same.
void give_to_owner_of(const std::filesystem::path& sample, int file) {
  struct stat owner {};
  if (::geteuid() == 0 && ::stat(sample.c_str(), &owner) == 0 && owner.st_uid != 0) {
    [[maybe_unused]] const int ignored = ::fchown(file, owner.st_uid, owner.st_gid);
  }
}

/// The descriptor, or −1 with errno. One that is there is opened without O_CREAT, which is refused
/// for another user's file in such a folder as /tmp, and writable only where that is allowed: a
/// lock over NFS asks for it, elsewhere reading is enough.
int open_lock_file(const std::filesystem::path& path, const std::filesystem::path& sample) {
  for (;;) {
    const int made = ::open(path.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0644);
    if (made >= 0) give_to_owner_of(sample, made);
    if (made >= 0 || errno != EEXIST) return made;
    int there = ::open(path.c_str(), O_RDWR | O_NOFOLLOW | O_CLOEXEC);
    if (there < 0 && errno == EACCES) {
      there = ::open(path.c_str(), O_RDONLY | O_NOFOLLOW | O_CLOEXEC);
    }
    if (there >= 0 || errno != ENOENT) return there;  // or it was removed just now
  }
}

std::string why_not_opened(const std::filesystem::path& path, int error) {
  const std::string name = "the lock file " + path.string();
  const std::string because = std::string(": ") + std::strerror(error);
  std::error_code unknown;
  if (std::filesystem::exists(path, unknown)) {
    return name + " cannot be opened" + because +
           "; remove it when neither biotomyd nor biotomy rebuild runs";
  }
  const std::string hint =
      error == EACCES   ? "; run this as a user who may write into " + path.parent_path().string()
      : error == ENOENT ? "; does the folder exist?"
                        : "";
  return name + " cannot be made" + because + hint;
}

}  // namespace

SampleLock::SampleLock(const std::filesystem::path& sample) {
  const std::filesystem::path path = lock_file_of(sample);
  file_ = bridge::UniqueFd(open_lock_file(path, sample));
  if (!file_.valid()) throw SampleLockError(why_not_opened(path, errno));
  if (::flock(file_.get(), LOCK_EX | LOCK_NB) != 0) {
    if (errno != EWOULDBLOCK) {
      throw SampleLockError("the lock file " + path.string() +
                            " cannot be locked: " + std::strerror(errno));
    }
    throw SampleLockError("another biotomyd works on the sample " + sample.string() +
                          ", or biotomy rebuild: stop it, or wait for its end");
  }
}

bool SampleLock::is_held(const std::filesystem::path& sample) {
  const bridge::UniqueFd file(::open(lock_file_of(sample).c_str(), O_RDONLY | O_CLOEXEC));
  return file.valid() && ::flock(file.get(), LOCK_SH | LOCK_NB) != 0 && errno == EWOULDBLOCK;
}

}  // namespace biotomy::acquisition
