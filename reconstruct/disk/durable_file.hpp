#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "reconstruct/disk/temporary_file.hpp"

namespace biotomy::reconstruct {

/// Writes `bytes` so that after a crash at any moment the name holds the old content or the new,
/// whole: a temporary file in the same folder, fsync, rename, fsync of the folder.
/// Throws SampleError, with the temporary file removed.
void write_durably(const std::filesystem::path& path, std::span<const std::byte> bytes);
void write_durably(const std::filesystem::path& path, const std::string& text);

/// A file of several parts, one after the other, that need not be put together in memory.
using FileParts = std::vector<std::vector<std::byte>>;
void write_durably(const std::filesystem::path& path, const FileParts& parts);

/// As write_durably, without the last step: after a crash the name may hold the old content until
/// sync_folder was called. For many files of one folder, which are then synced together.
void write_before_folder_sync(const std::filesystem::path& path, std::span<const std::byte> bytes);

/// A file that is on the disk, whole, and was read back and compared, but does not have its name
/// yet. Until `publish`, what its name held before is untouched; without it the file is removed.
/// Throws SampleError.
class VerifiedFile {
 public:
  VerifiedFile(const std::filesystem::path& path, std::span<const std::byte> bytes);

  /// Gives it its name, for good: after a crash it is still there.
  void publish();

  std::uint64_t bytes() const { return bytes_; }
  const std::string& sha256() const { return sha256_; }

 private:
  std::filesystem::path folder_;
  TemporaryFile file_;
  std::uint64_t bytes_;
  std::string sha256_;
};

/// Makes a folder and those above it, so that they are still there after a crash. Several threads
/// may make the same one. Throws SampleError.
void create_folders_durably(const std::filesystem::path& folder);

/// fsyncs a folder: what was created or renamed in it stays.
void sync_folder(const std::filesystem::path& folder);

/// fsyncs a folder, all folders below it and the one above it, if it is there: a program that was
/// killed may have made folders and not got to their fsync.
void sync_folders(const std::filesystem::path& folder);

}  // namespace biotomy::reconstruct
