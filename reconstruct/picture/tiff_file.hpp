#pragma once

#include <cstdarg>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <tiffio.h>

namespace biotomy::reconstruct {

/// A TIFF opened through libtiff. What libtiff complains of ends up in our exceptions, never on
/// stderr. Not for two threads at once.
class TiffFile {
 public:
  /// Opens a regular file for reading. Throws SampleError.
  static TiffFile open(const std::filesystem::path& path);

  /// Starts a little-endian TIFF in `memory`; `path` is for messages only. The file is whole once
  /// `finish` has returned.
  static TiffFile create(std::vector<std::byte>& memory, bool big,
                         const std::filesystem::path& path);

  /// Starts a little-endian TIFF on the disk, under its name at once. Throws SampleError.
  static TiffFile create_on_disk(const std::filesystem::path& path, bool big);

  TIFF* get() const { return tiff_.get(); }

  template <typename T>
  T number(std::uint32_t tag, T fallback) const {
    T value = fallback;
    return TIFFGetFieldDefaulted(get(), tag, &value) == 1 ? value : fallback;
  }

  /// A text tag of the page that it is turned to; none where the page has none.
  std::optional<std::string> text(std::uint32_t tag) const;

  template <typename... Values>
  void set(std::uint32_t tag, Values... values) {
    if (TIFFSetField(get(), tag, values...) != 1) {
      fail("cannot write its tag " + std::to_string(tag));
    }
  }

  /// Writes the directory and closes.
  void finish();

  /// Throws SampleError: the file, `what`, and libtiff's own words if it had any.
  [[noreturn]] void fail(const std::string& what) const;

 private:
  struct Report;
  struct Close {
    void operator()(TIFF* tiff) const { TIFFClose(tiff); }
  };
  explicit TiffFile(const std::filesystem::path& path);
  static int keep_message(TIFF* tiff, void* user_data, const char* module, const char* format,
                          va_list arguments);
  static int drop_message(TIFF* tiff, void* user_data, const char* module, const char* format,
                          va_list arguments);

  std::shared_ptr<Report> report_;  // libtiff keeps a pointer to it: declared before the TIFF
  std::unique_ptr<TIFF, Close> tiff_;
};

}  // namespace biotomy::reconstruct
