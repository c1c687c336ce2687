#include "reconstruct/disk/folder_owner.hpp"

#include <cerrno>
#include <cstring>
#include <memory>
#include <string>

#include <dirent.h>
#include <fcntl.h>
#include <pwd.h>
#include <sys/stat.h>
#include <unistd.h>

#include "reconstruct/disk/file_descriptor.hpp"
#include "reconstruct/errors.hpp"

namespace biotomy::reconstruct {
namespace {

namespace fs = std::filesystem;

struct stat status_of(const fs::path& folder) {
  struct stat status {};
  if (::stat(folder.c_str(), &status) != 0) {
    throw SampleError(folder.string() +
                      ": cannot see whose it is: " + std::string(std::strerror(errno)));
  }
  return status;
}

std::string name_of(uid_t user) {
  const passwd* found = ::getpwuid(user);
  return found != nullptr ? found->pw_name : "the user " + std::to_string(user);
}

/// A tree on its way to its owner. Names are looked up below open folders, and no link is followed:
/// whoever owns the folder around it cannot make root give him other files.
class HandedTree {
 public:
  HandedTree(const fs::path& tree, const struct stat& owner) : tree_(tree), owner_(owner) {}

  void hand_over() const {
    const FileDescriptor folder = open_folder(AT_FDCWD, tree_.c_str());
    hand_over_content(folder);
    if (::fchown(folder.get(), owner_.st_uid, owner_.st_gid) != 0 || ::syncfs(folder.get()) != 0) {
      fail();
    }
  }

 private:
  [[noreturn]] void fail() const {
    const int error = errno;
    throw SampleError(tree_.string() + ": cannot be given to " + name_of(owner_.st_uid) +
                      ", to whom the folder around it belongs: " + std::strerror(error));
  }

  FileDescriptor open_folder(int parent, const char* name) const {
    FileDescriptor folder(::openat(parent, name, O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC));
    if (!folder.is_open()) {
      fail();
    }
    return folder;
  }

  void hand_over_content(const FileDescriptor& folder) const {
    FileDescriptor listed = open_folder(folder.get(), ".");
    const std::unique_ptr<DIR, int (*)(DIR*)> list(::fdopendir(listed.get()), ::closedir);
    if (!list) {
      fail();
    }
    listed.release();  // closed with the list
    for (;;) {
      errno = 0;  // by which an error is told from the end
      const dirent* entry = ::readdir(list.get());
      if (entry == nullptr && errno != 0) {
        fail();
      }
      if (entry == nullptr) {
        return;
      }
      const char* name = entry->d_name;
      if (std::strcmp(name, ".") == 0 || std::strcmp(name, "..") == 0) {
        continue;
      }
      struct stat found {};
      if (::fstatat(folder.get(), name, &found, AT_SYMLINK_NOFOLLOW) != 0) {
        fail();
      }
      if (S_ISDIR(found.st_mode)) {
        hand_over_content(open_folder(folder.get(), name));
      }
      if (::fchownat(folder.get(), name, owner_.st_uid, owner_.st_gid, AT_SYMLINK_NOFOLLOW) != 0) {
        fail();
      }
    }
  }

  const fs::path& tree_;
  const struct stat& owner_;
};

}  // namespace

void check_acts_for_owner(const fs::path& folder) {
  const uid_t owner = status_of(folder).st_uid;
  if (::geteuid() != 0 && ::geteuid() != owner) {
    throw SampleError(folder.string() + ": belongs to " + name_of(owner) +
                      ", whose biotomyd could not go on with what another user makes in it; run "
                      "this as that user");
  }
}

void give_to_owner_of(const fs::path& model, const fs::path& tree) {
  const struct stat owner = status_of(model);
  if (::geteuid() == 0 && owner.st_uid != 0) {
    HandedTree(tree, owner).hand_over();
  }
}

}  // namespace biotomy::reconstruct
