#include "reconstruct/disk/durable_file.hpp"

#include <cerrno>
#include <cstring>

#include <fcntl.h>
#include <unistd.h>

#include "reconstruct/disk/file_descriptor.hpp"
#include "reconstruct/errors.hpp"

namespace biotomy::reconstruct {
namespace {

namespace fs = std::filesystem;

fs::path folder_of(const fs::path& path) {
  return path.has_parent_path() ? path.parent_path() : fs::path(".");
}

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

VerifiedFile::VerifiedFile(const fs::path& path, std::span<const std::byte> bytes)
    : folder_(folder_of(path)), file_(path), bytes_(bytes.size()) {
  file_.write(bytes);
  file_.sync();
  sha256_ = file_.read_back(bytes);
}

void VerifiedFile::publish() {
  file_.rename_to_target();
  sync_folder(folder_);
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
  try {
    sync_folder(folder_of(folder));
  } catch (const SampleError&) {
    fs::remove(folder, error);  // whoever tries again shall not take it for one that lasts
    throw;
  }
}

void sync_folders(const fs::path& folder) {
  std::error_code error;
  if (!fs::is_directory(folder, error)) {
    return;
  }
  sync_folder(folder_of(folder));
  sync_folder(folder);
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    if (entry.is_directory()) {
      sync_folder(entry.path());
    }
  }
}

void sync_folder(const fs::path& folder) {
  const FileDescriptor descriptor(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (!descriptor.is_open() || ::fsync(descriptor.get()) != 0) {
    const int error = errno;
    throw SampleError(folder.string() + ": cannot sync this folder: " + std::strerror(error));
  }
}

}  // namespace biotomy::reconstruct
