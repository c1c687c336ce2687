#include "reconstruct/store/sample_summary.hpp"

#include <filesystem>

#include "reconstruct/errors.hpp"
#include "reconstruct/store/volume.hpp"
#include "reconstruct/store/volume_misfit.hpp"

namespace biotomy::reconstruct {
namespace {

namespace fs = std::filesystem;

bool is_hidden(const fs::path& path) {
  return path.filename().string().front() == '.';  // still being written
}

std::uint64_t bytes_below(const fs::path& folder) {
  std::uint64_t bytes = 0;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    if (entry.is_regular_file() && !is_hidden(entry.path())) {
      bytes += entry.file_size();
    }
  }
  return bytes;
}

}  // namespace

SampleSummary summarise(const SampleFolder& sample) {
  SampleSummary summary;
  const std::int64_t layers = sample.description().cuboid.size.z;
  for (std::int64_t layer = 1; layer <= layers; ++layer) {
    std::error_code error;
    const std::uintmax_t bytes = fs::file_size(sample.layer_path(layer), error);
    if (!error) {
      ++summary.layer_images;
      summary.layer_bytes += bytes;
    }
  }
  try {
    if (fs::exists(sample.volume_path())) {
      const Volume volume = Volume::open(sample.volume_path());
      summary.has_volume = true;
      summary.volume_misfit = misfit(volume.cuboid(), volume.bits(), sample);
      summary.layers_in_volume = volume.layers_present();
      summary.layout = volume.layout();
      for (int level = 0; level < volume.levels(); ++level) {
        summary.levels.push_back(volume.level(level));
      }
      summary.volume_bytes = bytes_below(sample.volume_path());
    }
    summary.layers_in_sections =
        summary.layers_in_volume + sample.layers_on_disk(summary.layers_in_volume + 1);
  } catch (const fs::filesystem_error& error) {
    throw SampleError(sample.path().string() +
                      ": cannot be looked through: " + error.code().message());
  }
  return summary;
}

}  // namespace biotomy::reconstruct
