#include "reconstruct/store/durable_file.hpp"

#include <array>
#include <atomic>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <memory>
#include <sstream>
#include <string_view>
#include <utility>
#include <vector>

#include <fcntl.h>
#include <openssl/evp.h>
#include <signal.h>
#include <unistd.h>

#include "reconstruct/errors.hpp"
#include "reconstruct/store/file_descriptor.hpp"

namespace biotomy::reconstruct {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kReadBlock = std::size_t{1} << 20;

[[noreturn]] void fail(const fs::path& path, const std::string& what, int error) {
  throw SampleError(path.string() + ": cannot " + what + ": " + std::strerror(error));
}

fs::path folder_of(const fs::path& path) {
  return path.has_parent_path() ? path.parent_path() : fs::path(".");
}

class Sha256 {
 public:
  Sha256() : context_(EVP_MD_CTX_new()) {
    EVP_DigestInit_ex(context_.get(), EVP_sha256(), nullptr);
  }

  void add(std::span<const std::byte> bytes) {
    EVP_DigestUpdate(context_.get(), bytes.data(), bytes.size());
  }

  std::string finish() {
    std::array<unsigned char, EVP_MAX_MD_SIZE> digest{};
    unsigned int length = 0;
    EVP_DigestFinal_ex(context_.get(), digest.data(), &length);
    constexpr const char* kDigits = "0123456789abcdef";
    std::string hexadecimal;
    for (unsigned int i = 0; i < length; ++i) {
      hexadecimal += kDigits[digest[i] >> 4];
      hexadecimal += kDigits[digest[i] & 15];
    }
    return hexadecimal;
  }

 private:
  struct Free {
    void operator()(EVP_MD_CTX* context) const { EVP_MD_CTX_free(context); }
  };
  std::unique_ptr<EVP_MD_CTX, Free> context_;
};

std::string sha256_of_descriptor(const FileDescriptor& file, const fs::path& path) {
  Sha256 hash;
  std::vector<std::byte> block(kReadBlock);
  for (;;) {
    const ssize_t count = ::read(file.get(), block.data(), block.size());
    if (count < 0 && errno == EINTR) {
      continue;
    }
    if (count < 0) {
      fail(path, "read it", errno);
    }
    if (count == 0) {
      return hash.finish();
    }
    hash.add({block.data(), static_cast<std::size_t>(count)});
  }
}

/// `.NAME.PROCESS-NUMBER`; is_unfinished_write knows it again.
std::string temporary_name(const fs::path& target) {
  static std::atomic<unsigned> counter{0};
  std::ostringstream name;
  name << '.' << target.filename().string() << '.' << ::getpid() << '-' << counter++;
  return name.str();
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

/// A file beside the one that it is to replace; removed again unless it was renamed.
class TemporaryFile {
 public:
  explicit TemporaryFile(const fs::path& target) : target_(target) {
    path_ = folder_of(target) / temporary_name(target);
    file_ = FileDescriptor(::open(path_.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0644));
    if (!file_.is_open()) {
      fail(target, "create a file beside it", errno);
    }
  }
  ~TemporaryFile() {
    if (!renamed_) {
      ::unlink(path_.c_str());
    }
  }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;

  void write(std::span<const std::byte> bytes) {
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

  void sync() {
    if (::fsync(file_.get()) != 0) {
      fail(target_, "write it to the disk", errno);
    }
  }

  /// What the disk holds, not what the page cache remembers: the pages are clean after fsync and
  /// can be dropped, so that reading fetches them anew (where the file system obeys the advice).
  std::string hash_from_disk() {
    ::posix_fadvise(file_.get(), 0, 0, POSIX_FADV_DONTNEED);
    if (::lseek(file_.get(), 0, SEEK_SET) != 0) {
      fail(target_, "read it back", errno);
    }
    return sha256_of_descriptor(file_, target_);
  }

  void rename_to_target() {
    if (::rename(path_.c_str(), target_.c_str()) != 0) {
      fail(target_, "give the finished file its name", errno);
    }
    renamed_ = true;
  }

 private:
  fs::path target_;
  fs::path path_;
  FileDescriptor file_;
  bool renamed_ = false;
};

}  // namespace

void write_durably(const fs::path& path, std::span<const std::byte> bytes) {
  write_before_folder_sync(path, bytes);
  sync_folder(folder_of(path));
}

void write_before_folder_sync(const fs::path& path, std::span<const std::byte> bytes) {
  TemporaryFile file(path);
  file.write(bytes);
  file.sync();
  file.rename_to_target();
}

void write_durably(const fs::path& path, const FileParts& parts) {
  TemporaryFile file(path);
  for (const std::vector<std::byte>& part : parts) {
    file.write(part);
  }
  file.sync();
  file.rename_to_target();
  sync_folder(folder_of(path));
}

void write_durably(const fs::path& path, const std::string& text) {
  write_durably(path, std::as_bytes(std::span(text)));
}

std::string write_durably_verified(const fs::path& path, std::span<const std::byte> bytes) {
  std::string expected = sha256(bytes);
  TemporaryFile file(path);
  file.write(bytes);
  file.sync();
  if (file.hash_from_disk() != expected) {
    throw SampleError(path.string() +
                      ": what the disk gave back is not what was written; check the disk");
  }
  file.rename_to_target();
  sync_folder(folder_of(path));
  return expected;
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

void create_folders_durably(const fs::path& folder) {
  std::error_code error;
  if (fs::is_directory(folder, error)) {
    return;
  }
  create_folders_durably(folder_of(folder));
  fs::create_directory(folder, error);
  if (error) {
    throw SampleError(folder.string() + ": cannot create this folder: " + error.message());
  }
  sync_folder(folder_of(folder));
}

void sync_folder(const fs::path& folder) {
  const FileDescriptor descriptor(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (!descriptor.is_open() || ::fsync(descriptor.get()) != 0) {
    fail(folder, "sync this folder", errno);
  }
}

std::string sha256(std::span<const std::byte> bytes) {
  Sha256 hash;
  hash.add(bytes);
  return hash.finish();
}

std::string sha256_of_file(const fs::path& path) {
  const FileDescriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC));
  if (!file.is_open()) {
    fail(path, "open it", errno);
  }
  return sha256_of_descriptor(file, path);
}

}  // namespace biotomy::reconstruct
