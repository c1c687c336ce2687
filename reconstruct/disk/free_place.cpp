#include "reconstruct/disk/free_place.hpp"

#include <system_error>

#include <sys/stat.h>

#include "reconstruct/errors.hpp"

namespace biotomy::reconstruct {
namespace {

namespace fs = std::filesystem;

bool is_mount_point(const fs::path& folder) {
  struct stat here {};
  struct stat above {};
  return ::stat(folder.c_str(), &here) == 0 && ::stat(folder.parent_path().c_str(), &above) == 0 &&
         here.st_dev != above.st_dev;
}

}  // namespace

void check_place_is_free(const fs::path& place) {
  std::error_code error;
  if (fs::is_symlink(place, error)) {
    throw SampleError(place.string() + ": is a symbolic link: name the folder that it leads to");
  }
  if (!fs::exists(place, error)) {
    return;
  }
  if (is_mount_point(place)) {
    throw SampleError(place.string() + ": is a mount point: name a folder in it, or beside it");
  }
  if (!fs::is_directory(place, error) || !fs::is_empty(place, error)) {
    throw SampleError(place.string() +
                      ": is there already and not empty; choose another name or remove it");
  }
}

}  // namespace biotomy::reconstruct
