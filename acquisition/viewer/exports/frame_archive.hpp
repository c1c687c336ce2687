#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <span>
#include <string>

namespace biotomy::acquisition {

/// A ZIP archive being written file by file: pictures are compressed already and are stored as they
/// are. Not whole before `finish`.
class FrameArchive {
 public:
  /// Throws SampleError.
  explicit FrameArchive(const std::filesystem::path& path);
  ~FrameArchive();
  FrameArchive(const FrameArchive&) = delete;
  FrameArchive& operator=(const FrameArchive&) = delete;

  /// Throws SampleError when the disk takes no more.
  void add(const std::string& name, std::span<const std::byte> file);

  /// Throws SampleError. Afterwards all of it is on the disk.
  void finish();

 private:
  [[noreturn]] void fail() const;

  struct Close {
    void operator()(void* zip) const;
  };
  std::filesystem::path path_;
  std::unique_ptr<void, Close> zip_;
};

}  // namespace biotomy::acquisition
