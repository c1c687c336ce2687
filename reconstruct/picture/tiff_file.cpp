#include "reconstruct/picture/tiff_file.hpp"

#include <algorithm>
#include <array>
#include <cstdarg>
#include <cstdio>
#include <cstring>
#include <utility>

#include "reconstruct/disk/regular_file.hpp"
#include "reconstruct/errors.hpp"

namespace biotomy::reconstruct {
namespace {

/// The memory that libtiff takes for a file.
struct MemoryFile {
  std::vector<std::byte>* bytes = nullptr;
  std::size_t position = 0;
};

MemoryFile& file_of(thandle_t handle) {
  return *static_cast<MemoryFile*>(handle);
}

tmsize_t read_memory(thandle_t handle, void* data, tmsize_t size) {
  MemoryFile& file = file_of(handle);
  const std::size_t left = file.bytes->size() - std::min(file.position, file.bytes->size());
  const std::size_t count = std::min(static_cast<std::size_t>(size), left);
  if (count > 0) {
    std::memcpy(data, file.bytes->data() + file.position, count);
    file.position += count;
  }
  return static_cast<tmsize_t>(count);
}

tmsize_t write_memory(thandle_t handle, void* data, tmsize_t size) {
  if (size == 0) return 0;  // libtiff flushes empty buffers, which may be null
  MemoryFile& file = file_of(handle);
  const std::size_t end = file.position + static_cast<std::size_t>(size);
  if (end > file.bytes->size()) {
    file.bytes->resize(end);
  }
  std::memcpy(file.bytes->data() + file.position, data, static_cast<std::size_t>(size));
  file.position = end;
  return size;
}

toff_t seek_memory(thandle_t handle, toff_t offset, int whence) {
  MemoryFile& file = file_of(handle);
  const toff_t base = whence == SEEK_CUR   ? file.position
                      : whence == SEEK_END ? file.bytes->size()
                                           : 0;
  file.position = static_cast<std::size_t>(base + offset);
  return file.position;
}

int close_memory(thandle_t /*handle*/) {
  return 0;
}

toff_t size_of_memory(thandle_t handle) {
  return file_of(handle).bytes->size();
}

struct FreeOptions {
  void operator()(TIFFOpenOptions* options) const { TIFFOpenOptionsFree(options); }
};

}  // namespace

struct TiffFile::Report {
  std::filesystem::path path;
  std::string message;  // the first: those that follow are its consequences
  MemoryFile memory;
  std::unique_ptr<TIFFOpenOptions, FreeOptions> options{TIFFOpenOptionsAlloc()};
};

TiffFile::TiffFile(const std::filesystem::path& path) : report_(std::make_shared<Report>()) {
  report_->path = path;
  TIFFOpenOptionsSetErrorHandlerExtR(report_->options.get(), keep_message, report_.get());
  TIFFOpenOptionsSetWarningHandlerExtR(report_->options.get(), drop_message, nullptr);
}

int TiffFile::keep_message(TIFF* /*tiff*/, void* user_data, const char* /*module*/,
                           const char* format, va_list arguments) {
  std::array<char, 512> text{};
  std::vsnprintf(text.data(), text.size(), format, arguments);
  Report& report = *static_cast<Report*>(user_data);
  if (report.message.empty()) {
    report.message = text.data();
    std::replace(report.message.begin(), report.message.end(), '\n', ' ');
  }
  return 1;  // handled: libtiff's own handler, which prints, stays silent
}

int TiffFile::drop_message(TIFF* /*tiff*/, void* /*user_data*/, const char* /*module*/,
                           const char* /*format*/, va_list /*arguments*/) {
  return 1;
}

TiffFile TiffFile::open(const std::filesystem::path& path) {
  FileDescriptor descriptor = open_regular_file(path);
  TiffFile file(path);
  // Not mapped ('m'): a page that the disk cannot give is then an error and not a SIGBUS.
  file.tiff_.reset(
      TIFFFdOpenExt(descriptor.get(), path.c_str(), "rm", file.report_->options.get()));
  if (!file.tiff_) {
    file.fail("cannot be opened as a TIFF");
  }
  descriptor.release();  // libtiff closes it
  return file;
}

TiffFile TiffFile::create_on_disk(const std::filesystem::path& path, bool big) {
  TiffFile file(path);
  file.tiff_.reset(TIFFOpenExt(path.c_str(), big ? "wl8" : "wl", file.report_->options.get()));
  if (!file.tiff_) {
    file.fail("cannot be started as a TIFF");
  }
  return file;
}

TiffFile TiffFile::create(std::vector<std::byte>& memory, bool big,
                          const std::filesystem::path& path) {
  TiffFile file(path);
  file.report_->memory.bytes = &memory;
  file.tiff_.reset(TIFFClientOpenExt(
      path.c_str(), big ? "wl8" : "wl", &file.report_->memory, read_memory, write_memory,
      seek_memory, close_memory, size_of_memory, nullptr, nullptr, file.report_->options.get()));
  if (!file.tiff_) {
    file.fail("cannot be started as a TIFF");
  }
  return file;
}

std::optional<std::string> TiffFile::text(std::uint32_t tag) const {
  const char* words = nullptr;
  if (TIFFGetField(get(), tag, &words) != 1 || words == nullptr) {
    return std::nullopt;
  }
  return words;
}

void TiffFile::finish() {
  if (TIFFWriteDirectory(get()) != 1) {
    fail("cannot write its directory");
  }
  tiff_.reset();
}

void TiffFile::fail(const std::string& what) const {
  throw SampleError(report_->path.string() + ": " + what +
                    (report_->message.empty() ? "" : " (" + report_->message + ")"));
}

}  // namespace biotomy::reconstruct
