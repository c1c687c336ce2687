#pragma once

#include <cstddef>
#include <filesystem>

#include "reconstruct/disk/file_descriptor.hpp"

namespace biotomy::reconstruct {

/// A folder that is written beside its final name, `.NAME.partial`, and gets it when it is
/// complete; removed when it does not come to that.
class UnfinishedExport {
 public:
  /// Throws SampleError when `output` is there and not an empty folder (or a link, or a mount
  /// point), when another program exports to it, when an interrupted import of it is kept in the
  /// folder, or when the folder cannot be made.
  explicit UnfinishedExport(const std::filesystem::path& output);
  ~UnfinishedExport();
  UnfinishedExport(const UnfinishedExport&) = delete;
  UnfinishedExport& operator=(const UnfinishedExport&) = delete;

  const std::filesystem::path& folder() const { return folder_; }

  /// Everything is on the disk before the name is.
  void finish();

 private:
  std::filesystem::path output_;
  std::filesystem::path folder_;
  FileDescriptor lock_;
  bool finished_ = false;
};

/// Writes a file, without waiting for the disk. Throws SampleError, naming it.
void write_plainly(const std::filesystem::path& path, const void* data, std::size_t size);

}  // namespace biotomy::reconstruct
