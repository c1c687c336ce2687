#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>

#include "reconstruct/disk/file_descriptor.hpp"

namespace biotomy::reconstruct {

/// A hidden file beside the one that it is to become; removed again unless it was renamed. Every
/// call throws SampleError, which names the file that it was to become. After any failure the file
/// is good for nothing but being removed: a disk that failed an fsync once may report the next one
/// as done without having written what the first one lost.
class TemporaryFile {
 public:
  explicit TemporaryFile(const std::filesystem::path& target);
  ~TemporaryFile();
  TemporaryFile(TemporaryFile&& other) noexcept;
  TemporaryFile& operator=(TemporaryFile&&) = delete;
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;

  /// Appends.
  void write(std::span<const std::byte> bytes);

  void sync();

  /// Reads the file back, compares it with what it should hold and gives the SHA-256 of what was
  /// read. After `sync` that is what the disk holds, not what the page cache remembers, where the
  /// file system takes the advice to forget clean pages.
  std::string read_back(std::span<const std::byte> expected);

  /// Gives it its name. That the name stays is up to sync_folder.
  void rename_to_target();

 private:
  std::filesystem::path target_;
  std::filesystem::path path_;  ///< empty once it was renamed or moved from
  FileDescriptor file_;
};

/// Whether this is a file that a process was writing when it was ended by force: it has the
/// name of a TemporaryFile, and no process of that number lives but this one.
bool is_unfinished_write(const std::filesystem::path& path);

/// Removes the unfinished writes below a folder, at any depth. Nothing of this process may be
/// under way there. What cannot be removed stays: it is hidden and does no harm.
void remove_unfinished_writes(const std::filesystem::path& folder);

}  // namespace biotomy::reconstruct
