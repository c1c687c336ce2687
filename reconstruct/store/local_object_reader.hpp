#pragma once

#include <filesystem>
#include <memory>
#include <mutex>

#include "reconstruct/disk/file_descriptor.hpp"
#include "reconstruct/store/lru_map.hpp"
#include "reconstruct/store/object_reader.hpp"

namespace biotomy::reconstruct {

/// Objects are the files below a folder. Keeps at most `most_open` of them open.
class LocalObjectReader : public ObjectReader {
 public:
  explicit LocalObjectReader(std::filesystem::path root, std::size_t most_open = 64);

  std::string describe(const std::string& name) const override;
  std::optional<ObjectVersion> version(const std::string& name) override;
  void read(const std::string& name, const ObjectVersion& version, std::uint64_t offset,
            std::span<std::byte> out) override;
  void expect(const std::string& name, const ObjectVersion& version, std::uint64_t offset,
              std::uint64_t length) override;

 private:
  struct OpenFile {
    FileDescriptor descriptor;
    ObjectVersion version;
  };

  /// The file with exactly this version, open; kept alive by its users when it is evicted.
  std::shared_ptr<const OpenFile> open(const std::string& name, const ObjectVersion& version);

  std::filesystem::path root_;
  std::mutex mutex_;
  LruMap<std::string, std::shared_ptr<const OpenFile>> open_files_;
};

}  // namespace biotomy::reconstruct
