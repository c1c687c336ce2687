#include "reconstruct/disk/folder_swap.hpp"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <string>
#include <system_error>

#include <fcntl.h>

#include "reconstruct/disk/durable_file.hpp"
#include "reconstruct/errors.hpp"

namespace biotomy::reconstruct {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail(const fs::path& place, int error) {
  throw SampleError(place.string() +
                    ": cannot be replaced by what was made beside it: " + std::strerror(error));
}

/// False when the file system cannot.
bool exchange(const fs::path& fresh, const fs::path& place) {
  if (::renameat2(AT_FDCWD, fresh.c_str(), AT_FDCWD, place.c_str(), RENAME_EXCHANGE) == 0) {
    return true;
  }
  if (errno != EINVAL && errno != ENOSYS && errno != ENOTSUP) {
    fail(place, errno);
  }
  return false;
}

void rename_or_fail(const fs::path& from, const fs::path& to, const fs::path& place) {
  if (::rename(from.c_str(), to.c_str()) != 0) {
    fail(place, errno);
  }
}

void swap_in_three_steps(const fs::path& fresh, const fs::path& place) {
  fs::path aside = fresh;
  aside += ".old";
  remove_folder(aside);
  rename_or_fail(place, aside, place);
  if (::rename(fresh.c_str(), place.c_str()) != 0) {
    const int error = errno;
    rename_or_fail(aside, place, place);
    fail(place, error);
  }
  rename_or_fail(aside, fresh, place);
}

void swap(const fs::path& fresh, const fs::path& place) {
  if (!exchange(fresh, place)) {
    swap_in_three_steps(fresh, place);
  }
}

}  // namespace

void replace_folder(const fs::path& fresh, const fs::path& place) {
  std::error_code error;
  if (!fs::exists(place, error)) {
    rename_or_fail(fresh, place, place);
    sync_folder(place.parent_path());
    return;
  }
  swap(fresh, place);
  try {
    sync_folder(place.parent_path());
  } catch (const SampleError&) {
    swap(fresh, place);  // what is not known to last takes nothing's place
    throw;
  }
  remove_folder(fresh);  // it has the old content now
}

void remove_folder(const fs::path& folder) {
  std::error_code error;
  fs::remove_all(folder, error);
  if (error) {
    throw SampleError(folder.string() + ": cannot be removed: " + error.message());
  }
}

}  // namespace biotomy::reconstruct
