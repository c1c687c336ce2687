#include "acquisition/viewer/exports/frame_archive.hpp"

#include <algorithm>

#include <fcntl.h>
#include <minizip/zip.h>
#include <unistd.h>

#include "reconstruct/disk/file_descriptor.hpp"
#include "reconstruct/errors.hpp"

namespace biotomy::acquisition {
namespace {

constexpr int kStored = 0;
constexpr std::size_t kMostAtOnce = std::size_t{1} << 24;

}  // namespace

void FrameArchive::Close::operator()(void* zip) const {
  zipClose(zip, nullptr);
}

FrameArchive::FrameArchive(const std::filesystem::path& path)
    : path_(path), zip_(zipOpen64(path.c_str(), APPEND_STATUS_CREATE)) {
  if (!zip_) fail();
}

FrameArchive::~FrameArchive() = default;

void FrameArchive::add(const std::string& name, std::span<const std::byte> file) {
  // The time is the same in all archives: what differs is what is in them.
  zip_fileinfo info{};
  info.tmz_date.tm_year = 1980;
  info.tmz_date.tm_mday = 1;
  const int zip64 = file.size() >= 0xffffffffU ? 1 : 0;
  if (zipOpenNewFileInZip64(zip_.get(), name.c_str(), &info, nullptr, 0, nullptr, 0, nullptr,
                            kStored, 0, zip64) != ZIP_OK) {
    fail();
  }
  while (!file.empty()) {
    const std::size_t count = std::min(file.size(), kMostAtOnce);
    if (zipWriteInFileInZip(zip_.get(), file.data(), static_cast<unsigned>(count)) != ZIP_OK) {
      fail();
    }
    file = file.subspan(count);
  }
  if (zipCloseFileInZip(zip_.get()) != ZIP_OK) fail();
}

void FrameArchive::finish() {
  if (zipClose(zip_.release(), nullptr) != ZIP_OK) fail();
  const reconstruct::FileDescriptor file(::open(path_.c_str(), O_RDONLY | O_CLOEXEC));
  if (!file.is_open() || ::fsync(file.get()) != 0) fail();
}

void FrameArchive::fail() const {
  throw reconstruct::SampleError(path_.string() + ": cannot be written; is the disk full?");
}

}  // namespace biotomy::acquisition
