#pragma once

#include <filesystem>
#include <map>
#include <mutex>
#include <optional>
#include <string>

#include <nlohmann/json_fwd.hpp>

#include "reconstruct/disk/file_descriptor.hpp"
#include "reconstruct/sample/sample_folder.hpp"

namespace biotomy::reconstruct {

/// Whether a folder `.NAME.partial` is that of an import that can be taken up again.
bool holds_import(const std::filesystem::path& folder);

/// An import on its way: the folder `.NAME.partial` beside the output, in which there are
/// `request.json` (what was asked), `layers.sha256` (the layers that are stored, in the order in
/// which they were) and `sample/`, which becomes the output. All of it survives a crash, so that
/// the import can be taken up again. A lock keeps two imports of one output apart.
class PartialImport {
 public:
  /// Takes up the import that was begun, if it has a layer, or begins one. `asked` is its
  /// import_record. Throws SampleError when the output is there already, another process works on
  /// it, or what was begun was another request or of images of another size or depth (unless
  /// `restart`, which then begins anew).
  PartialImport(const std::filesystem::path& output, const SampleDescription& description,
                const nlohmann::json& asked, bool restart);
  PartialImport(const PartialImport&) = delete;
  PartialImport& operator=(const PartialImport&) = delete;

  /// The sample that grows.
  const SampleFolder& sample() const { return *sample_; }
  const std::filesystem::path& folder() const { return folder_; }

  bool is_stored(std::int64_t layer) const;
  std::int64_t stored_layers() const;

  /// The layer's file is whole on the disk and has its name: writes that down. What a crash takes
  /// away of the names or of these records since the last `sync` is imported again. Safe for many
  /// threads.
  void add_stored(std::int64_t layer, const std::string& sha256);

  /// From here on no crash takes away what was stored before.
  void sync();

  /// Gives the sample its hashes and its final name.
  std::filesystem::path finish();

  /// Removes all of it, as far as that can be done.
  void discard() noexcept;

 private:
  void refuse_if_taken() const;
  /// Whether there was one that has layers.
  bool take_up(const SampleDescription& description, const nlohmann::json& asked);
  nlohmann::json begun_request() const;
  void open_begun_sample();
  void take_up_hashes();
  void begin(const SampleDescription& description, const nlohmann::json& asked);
  std::filesystem::path hashes_path() const { return folder_ / "layers.sha256"; }

  std::filesystem::path output_;
  std::filesystem::path folder_;
  FileDescriptor lock_;
  std::optional<SampleFolder> sample_;
  mutable std::mutex mutex_;
  FileDescriptor hashes_file_;
  std::map<std::string, std::string> stored_;  // hash of each layer file
};

}  // namespace biotomy::reconstruct
