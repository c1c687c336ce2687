#include "acquisition/records/surroundings.hpp"

#include <memory>

#include "reconstruct/store/volume_writer.hpp"

namespace biotomy::acquisition {
namespace {

/// The volume is opened by the first append, in the feed's own thread.
VolumeFeed::Append append_to_volume(const reconstruct::SampleFolder& sample,
                                    const reconstruct::VolumeLayout& layout) {
  auto writer = std::make_shared<std::unique_ptr<reconstruct::VolumeWriter>>();
  return [sample, layout, writer](std::int64_t available, bool finish,
                                  const std::function<void(std::int64_t)>& progress) {
    if (!*writer) *writer = std::make_unique<reconstruct::VolumeWriter>(sample, layout);
    progress((*writer)->layers_written());
    (*writer)->append(available, finish, progress);
  };
}

}  // namespace

Surroundings real_surroundings() {
  return {
      .wall_clock = [] { return std::chrono::system_clock::now(); },
      .free_bytes =
          [](const std::filesystem::path& path) { return std::filesystem::space(path).available; },
      .prepare_layer = reconstruct::prepare_layer_image,
      .read_layer = reconstruct::read_layer_image,
      .open_volume = append_to_volume};
}

}  // namespace biotomy::acquisition
