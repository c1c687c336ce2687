#include "acquisition/viewer/section_task.hpp"

#include <utility>

namespace biotomy::acquisition {

PictureTask section_task(LiveSample& live, const Query& query) {
  const SectionQuery asked = section_query(query);
  std::shared_ptr<const SampleView> view = look_at_layers(live);
  const reconstruct::Volume& volume = view->sample.volume;
  const std::filesystem::path& folder = view->sample.folder.path();
  const SectionQuery smaller = fitted(asked, volume.cuboid(), volume.bits());
  const reconstruct::SectionRequest request = section_request(smaller, volume.cuboid());
  PictureTask task{.view = nullptr,
                   .request = request,
                   .outline = outline_of_any_size(*view, request),
                   .full = outline_of_any_size(*view, section_request(asked, volume.cuboid())).grid,
                   .format = format_of(asked.format),
                   .quality = reconstruct::parse_quality("quality", asked.quality),
                   .parameters = section_command_parameters(smaller),
                   .command = section_command(asked, folder),
                   .command_here = section_command(smaller, folder)};
  task.view = std::move(view);
  return task;
}

}  // namespace biotomy::acquisition
