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

[[noreturn]] void fail_to_put_back(const fs::path& old, const fs::path& place, int error) {
  throw SampleError(place.string() + ": what was there lies in " + old.string() +
                    " and cannot be put back: " + std::strerror(error));
}

/// The number of the error; 0 when there was none.
int renamed(const fs::path& from, const fs::path& to) {
  return ::rename(from.c_str(), to.c_str()) == 0 ? 0 : errno;
}

int exchanged(const fs::path& a, const fs::path& b) {
  const int result = ::renameat2(AT_FDCWD, a.c_str(), AT_FDCWD, b.c_str(), RENAME_EXCHANGE);
  return result == 0 ? 0 : errno;
}

bool cannot_exchange(int error) {
  return error == EINVAL || error == ENOSYS || error == ENOTSUP;
}

/// Returns where the old content of `place` is now.
fs::path swap(const fs::path& fresh, const fs::path& place) {
  if (const int error = exchanged(fresh, place); error == 0) {
    return fresh;
  } else if (!cannot_exchange(error)) {
    fail(place, error);
  }
  fs::path aside = name_aside(fresh);
  remove_folder(aside);
  if (const int error = renamed(place, aside); error != 0) {
    fail(place, error);
  }
  if (const int error = renamed(fresh, place); error != 0) {
    if (const int worse = renamed(aside, place); worse != 0) {
      fail_to_put_back(aside, place, worse);
    }
    fail(place, error);
  }
  return aside;
}

void swap_back(const fs::path& old, const fs::path& fresh, const fs::path& place) {
  int error = 0;
  if (old == fresh) {
    error = exchanged(fresh, place);
  } else {
    error = renamed(place, fresh);
    error = error == 0 ? renamed(old, place) : error;
  }
  if (error != 0) {
    fail_to_put_back(old, place, error);
  }
}

}  // namespace

fs::path name_aside(const fs::path& fresh) {
  fs::path aside = fresh;
  aside += ".old";
  return aside;
}

void replace_folder(const fs::path& fresh, const fs::path& place) {
  std::error_code error;
  if (!fs::exists(place, error)) {
    if (const int rename_error = renamed(fresh, place); rename_error != 0) {
      fail(place, rename_error);
    }
    sync_folder(place.parent_path());
    return;
  }
  const fs::path old = swap(fresh, place);
  try {
    sync_folder(place.parent_path());
  } catch (const SampleError&) {
    swap_back(old, fresh, place);  // what is not known to last takes nothing's place
    throw;
  }
  remove_folder(old);
}

void settle_replaced_folder(const fs::path& fresh, const fs::path& place) {
  const fs::path aside = name_aside(fresh);
  std::error_code error;
  if (!fs::exists(aside, error)) {
    return;
  }
  if (fs::exists(place, error)) {
    remove_folder(aside);
  } else {
    if (const int rename_error = renamed(aside, place); rename_error != 0) {
      fail_to_put_back(aside, place, rename_error);
    }
    sync_folder(place.parent_path());
  }
}

void remove_folder(const fs::path& folder) {
  std::error_code error;
  fs::remove_all(folder, error);
  if (error) {
    throw SampleError(folder.string() + ": cannot be removed: " + error.message());
  }
}

}  // namespace biotomy::reconstruct
