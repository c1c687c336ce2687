#include "reconstruct/disk/temporary_file.hpp"

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <sstream>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include <fcntl.h>
#include <unistd.h>

#include "reconstruct/disk/sha256_hash.hpp"
#include "reconstruct/errors.hpp"

namespace biotomy::reconstruct {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kReadBlock = std::size_t{1} << 20;

[[noreturn]] void fail(const fs::path& path, const std::string& what, int error) {
  throw SampleError(path.string() + ": cannot " + what + ": " + std::strerror(error));
}

/// `.NAME.PROCESS-NUMBER`; is_unfinished_write knows it again.
fs::path fresh_name(const fs::path& target) {
  static std::atomic<unsigned> counter{0};
  std::ostringstream name;
  name << '.' << target.filename().string() << '.' << ::getpid() << '-' << counter++;
  return target.parent_path() / name.str();
}

/// Takes the decimal digits at the end of `text` off; empty if there are none.
std::string_view take_last_digits(std::string_view& text) {
  const std::size_t begin = text.find_last_not_of("0123456789") + 1;
  const std::string_view digits = text.substr(begin);
  text.remove_suffix(digits.size());
  return digits;
}

bool lives(pid_t process) {
  return ::kill(process, 0) == 0 || errno != ESRCH;
}

}  // namespace

TemporaryFile::TemporaryFile(const fs::path& target) : target_(target) {
  // A number may be taken by a file that was left when another process with this one's was killed.
  do {
    path_ = fresh_name(target);
    file_ = FileDescriptor(::open(path_.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0644));
  } while (!file_.is_open() && errno == EEXIST);
  if (!file_.is_open()) {
    path_.clear();
    fail(target, "create a file beside it", errno);
  }
}

TemporaryFile::TemporaryFile(TemporaryFile&& other) noexcept
    : target_(std::move(other.target_)),
      path_(std::exchange(other.path_, {})),
      file_(std::move(other.file_)) {}

TemporaryFile::~TemporaryFile() {
  if (!path_.empty()) {
    ::unlink(path_.c_str());
  }
}

void TemporaryFile::write(std::span<const std::byte> bytes) {
  while (!bytes.empty()) {
    const ssize_t count = ::write(file_.get(), bytes.data(), bytes.size());
    if (count < 0 && errno == EINTR) {
      continue;
    }
    if (count < 0) {
      fail(target_, "write it", errno);
    }
    bytes = bytes.subspan(static_cast<std::size_t>(count));
  }
}

void TemporaryFile::sync() {
  if (::fsync(file_.get()) != 0) {
    fail(target_, "write it to the disk", errno);
  }
}

std::string TemporaryFile::read_back(std::span<const std::byte> expected) {
  ::posix_fadvise(file_.get(), 0, 0, POSIX_FADV_DONTNEED);
  if (::lseek(file_.get(), 0, SEEK_SET) != 0) {
    fail(target_, "read it back", errno);
  }
  Sha256Hash hash;
  std::vector<std::byte> block(kReadBlock);
  for (;;) {
    const ssize_t count = ::read(file_.get(), block.data(), block.size());
    if (count < 0 && errno == EINTR) {
      continue;
    }
    if (count < 0) {
      fail(target_, "read it back", errno);
    }
    const std::span<const std::byte> read(block.data(), static_cast<std::size_t>(count));
    const bool at_end = read.empty();
    const bool same = at_end ? expected.empty()
                             : read.size() <= expected.size() &&
                                   std::memcmp(read.data(), expected.data(), read.size()) == 0;
    if (!same) {
      throw SampleError(target_.string() +
                        ": what the disk gave back is not what was written; check the disk");
    }
    if (at_end) {
      return hash.finish();
    }
    hash.add(read);
    expected = expected.subspan(read.size());
  }
}

void TemporaryFile::rename_to_target() {
  if (::rename(path_.c_str(), target_.c_str()) != 0) {
    fail(target_, "give the finished file its name", errno);
  }
  path_.clear();
}

bool is_unfinished_write(const fs::path& path) {
  const std::string name = path.filename().string();
  std::string_view rest = name;
  if (take_last_digits(rest).empty() || !rest.ends_with('-')) {
    return false;
  }
  rest.remove_suffix(1);
  const std::string process(take_last_digits(rest));
  const bool is_named_so = rest.size() > 2 && rest.starts_with('.') && rest.ends_with('.');
  constexpr std::size_t kMostDigits = 9;
  if (!is_named_so || process.empty() || process.size() > kMostDigits) {
    return false;
  }
  const pid_t number = std::stoi(process);
  std::error_code error;
  return fs::is_regular_file(fs::symlink_status(path, error)) &&
         (number == ::getpid() || !lives(number));
}

void remove_unfinished_writes(const fs::path& folder) {
  std::vector<fs::path> unfinished;
  std::error_code error;
  for (auto entry = fs::recursive_directory_iterator(folder, error);
       !error && entry != fs::recursive_directory_iterator(); entry.increment(error)) {
    if (is_unfinished_write(entry->path())) {
      unfinished.push_back(entry->path());
    }
  }
  for (const fs::path& path : unfinished) {
    fs::remove(path, error);
  }
}

}  // namespace biotomy::reconstruct
