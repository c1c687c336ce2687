#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "acquisition/viewer/exports/export_record.hpp"
#include "reconstruct/disk/file_descriptor.hpp"

namespace biotomy::acquisition {

/// An export in the making: a hidden folder that only its maker touches, and that goes with it
/// unless it is published.
class UnfinishedExport {
 public:
  /// Throws SampleError when it cannot be made.
  UnfinishedExport(std::filesystem::path exports, const std::string& id);
  ~UnfinishedExport();
  UnfinishedExport(const UnfinishedExport&) = delete;
  UnfinishedExport& operator=(const UnfinishedExport&) = delete;

  const std::filesystem::path& path() const { return path_; }

  /// Writes the record beside the files and gives the folder its name, for good. Throws
  /// SampleError.
  void publish(const ExportRecord& record);

 private:
  std::filesystem::path exports_;
  std::filesystem::path path_;
  reconstruct::FileDescriptor lock_;
};

/// Where exports lie: `ID/` with the files and `export.json`, one a finished export. Whatever else
/// lies there is left alone.
class ExportFolder {
 public:
  explicit ExportFolder(std::filesystem::path path) : path_(std::move(path)) {}

  const std::filesystem::path& path() const { return path_; }

  /// Removes what killed programs have left unfinished; another program's work goes on. Gives the
  /// exports that are done, in the order of their ids.
  std::vector<ExportRecord> sweep() const;

  /// Makes the folder if it is not there. Throws SampleError.
  std::unique_ptr<UnfinishedExport> begin(const std::string& id) const;

  std::filesystem::path file(const std::string& id, const std::string& name) const {
    return path_ / id / name;
  }

  /// Removes a finished export.
  void remove(const ExportRecord& record) const;

  /// Bytes that its disk has free.
  std::uint64_t free_bytes() const;

 private:
  std::filesystem::path path_;
};

}  // namespace biotomy::acquisition
