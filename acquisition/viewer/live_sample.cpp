#include "acquisition/viewer/live_sample.hpp"

#include <chrono>
#include <utility>

#include <sys/stat.h>

#include "acquisition/viewer/file_version.hpp"
#include "reconstruct/errors.hpp"
#include "reconstruct/sample/sample_folder.hpp"

namespace biotomy::acquisition {
namespace {

namespace fs = std::filesystem;

/// Of a folder, whatever is put into it meanwhile.
std::string folder_number(const fs::path& folder) {
  struct stat status {};
  return ::stat(folder.c_str(), &status) == 0 ? std::to_string(status.st_ino) : "";
}

std::uint64_t milliseconds_now() {
  return static_cast<std::uint64_t>(std::chrono::duration_cast<std::chrono::milliseconds>(
                                        std::chrono::system_clock::now().time_since_epoch())
                                        .count());
}

}  // namespace

SampleView::SampleView(const fs::path& folder, std::size_t cache_bytes)
    : sample(folder), bricks(sample.volume, cache_bytes, {}, &sample.tail) {}

SampleView::SampleView(const fs::path& folder, std::size_t cache_bytes, const SampleView& before)
    : sample(folder), bricks(sample.volume, cache_bytes, {}, &sample.tail, before.bricks) {}

LiveSample::LiveSample(const fs::path& folder, std::size_t cache_bytes)
    : folder_(fs::absolute(folder).lexically_normal()),
      cache_bytes_(cache_bytes),
      generation_(milliseconds_now()) {}

void LiveSample::refresh() {
  const std::string files =
      file_version(folder_ / reconstruct::SampleFolder::kDescriptionName) + ';' +
      file_version(folder_ / reconstruct::SampleFolder::kVolumeName / "zarr.json");
  const std::int64_t known = view_ ? view_->sample.tail.layers_present() : 0;
  if (view_ && files == files_ && view_->sample.folder.layers_on_disk(known + 1) == 0) return;
  const bool other_files = files != files_;
  files_ = files;
  const std::string volume = folder_number(folder_ / reconstruct::SampleFolder::kVolumeName);
  const std::shared_ptr<const SampleView> before =
      volume == volume_ ? std::exchange(view_, nullptr) : nullptr;
  view_ = nullptr;
  volume_ = volume;
  if (other_files) ++generation_;
  auto opened = before ? std::make_shared<SampleView>(folder_, cache_bytes_, *before)
                       : std::make_shared<SampleView>(folder_, cache_bytes_);
  if (!other_files && opened->sample.tail.layers_present() != known) ++generation_;
  opened->generation = generation_;
  view_ = std::move(opened);
}

bool LiveSample::is_there() const {
  return fs::exists(folder_ / reconstruct::SampleFolder::kDescriptionName);
}

std::shared_ptr<const SampleView> LiveSample::look() {
  const std::lock_guard lock(mutex_);
  refresh();
  return view_;
}

std::uint64_t LiveSample::generation() {
  const std::lock_guard lock(mutex_);
  try {
    refresh();
  } catch (const reconstruct::SampleError&) {
    // Whoever asks for a picture is told.
  }
  return generation_;
}

}  // namespace biotomy::acquisition
