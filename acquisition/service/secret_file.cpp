#include "acquisition/service/secret_file.hpp"

#include <cerrno>
#include <cstdlib>
#include <cstring>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include "firmware_bridge/wire/unique_fd.hpp"

namespace biotomy::acquisition {
namespace {

constexpr std::size_t kLargestFile = 65536;

[[noreturn]] void fail(const std::filesystem::path& file, const std::string& what,
                       const std::string& problem) {
  throw SecretFileError(what + " " + file.string() + " " + problem);
}

/// Looks at the open file, not at its name, which may mean another file a moment later.
void check_trust(const std::filesystem::path& file, const std::string& what, int descriptor) {
  struct stat found {};
  if (::fstat(descriptor, &found) != 0) {
    fail(file, what, std::string("cannot be read: ") + std::strerror(errno));
  }
  if (!S_ISREG(found.st_mode)) fail(file, what, "is not a regular file: give one");
  if (found.st_uid != ::geteuid() && found.st_uid != 0) {
    fail(file, what,
         "belongs to the user " + std::to_string(found.st_uid) +
             ", who can change it: chown it to the daemon's user or to root");
  }
  if ((found.st_mode & (S_IRWXG | S_IRWXO)) != 0) {
    fail(file, what, "is open to others: chmod 600 it");
  }
}

}  // namespace

std::string read_secret_file(const std::filesystem::path& file, const std::string& what) {
  // O_NONBLOCK: opening a pipe in place of the file must not wait for its other end.
  const bridge::UniqueFd found(
      ::open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK));
  if (!found.valid()) {
    if (errno == ELOOP) fail(file, what, "is a symbolic link: give the file itself");
    fail(file, what, std::string("cannot be read: ") + std::strerror(errno));
  }
  check_trust(file, what, found.get());

  std::string text(kLargestFile + 1, '\0');
  std::size_t length = 0;
  while (length < text.size()) {
    const ssize_t count = ::read(found.get(), text.data() + length, text.size() - length);
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) fail(file, what, std::string("cannot be read: ") + std::strerror(errno));
    if (count == 0) break;
    length += static_cast<std::size_t>(count);
  }
  if (length > kLargestFile) fail(file, what, "is larger than 64 KiB: is it the right file?");
  text.resize(length);
  return text;
}

bool make_secret_file(const std::filesystem::path& file, const std::string& what,
                      const std::string& text) {
  // It gets its name when it is whole: a process that is killed before leaves a hidden file that
  // nobody reads, not an empty secret.
  std::string beside = (file.parent_path() / ("." + file.filename().string() + ".XXXXXX")).string();
  const bridge::UniqueFd made(::mkostemp(beside.data(), O_CLOEXEC));  // for its owner alone
  if (!made.valid()) fail(file, what, std::string("cannot be made: ") + std::strerror(errno));
  const ssize_t written = ::write(made.get(), text.data(), text.size());
  const bool whole = written == static_cast<ssize_t>(text.size()) && ::fsync(made.get()) == 0;
  const bool named = whole && ::link(beside.c_str(), file.c_str()) == 0;
  const int error = errno;
  ::unlink(beside.c_str());
  if (named) return true;
  if (whole && error == EEXIST) return false;
  fail(file, what, std::string("cannot be written: ") + std::strerror(error));
}

}  // namespace biotomy::acquisition
