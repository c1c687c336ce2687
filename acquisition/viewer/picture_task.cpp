#include "acquisition/viewer/picture_task.hpp"

#include <limits>
#include <vector>

#include "acquisition/viewer/refusal.hpp"
#include "acquisition/viewer/section_query.hpp"
#include "acquisition/viewer/time_allowed.hpp"
#include "reconstruct/section/level_choice.hpp"
#include "reconstruct/section/section_record.hpp"

namespace biotomy::acquisition {
namespace {

using nlohmann::ordered_json;
using reconstruct::SectionRecord;

constexpr const char* kHeader = "Biotomy-Section";

SectionRecord record_of(const PictureTask& task) {
  const reconstruct::PixelGrid& grid = task.outline.grid;
  const reconstruct::LevelChoice levels =
      reconstruct::level_choice(task.view->bricks, grid, task.request.style.interpolation);
  const reconstruct::OpenedSample& sample = task.view->sample;
  return {sample.folder.description().name,
          sample.volume.cuboid(),
          task.request.plane,
          task.outline,
          {grid.columns, grid.rows},
          {0, 0},
          levels.levels(),
          task.parameters};
}

/// As SectionRecord's JSON, and what a page needs beside it.
std::string record_text(const PictureTask& task, const SectionRecord& record) {
  ordered_json document = to_json(record);
  document["full"] = {
      {"pixel_um", task.full.pixel}, {"width", task.full.columns}, {"height", task.full.rows}};
  document["command"] = task.command;
  document["command_here"] = task.command_here;
  document["layers_present"] = task.view->sample.tail.layers_present();
  document["generation"] = task.view->generation;
  return reconstruct::json_text(document);
}

void refuse_too_large(const reconstruct::PixelGrid& grid) {
  const std::int64_t pixels = std::int64_t{grid.columns} * grid.rows;
  if (pixels <= kMostPixelsAtOnce) return;
  throw Refusal(413, "the picture would have " + std::to_string(grid.columns) + " x " +
                         std::to_string(grid.rows) + " pixels, and " +
                         std::to_string(kMostPixelsAtOnce / 1'000'000) +
                         " million are the most that is answered at once: ask for fit=WxH or a "
                         "larger pixel, or have it written as a file by POST /api/v1/exports");
}

}  // namespace

std::shared_ptr<const SampleView> look_at_layers(LiveSample& live) {
  std::shared_ptr<const SampleView> view = live.look();
  if (view->sample.tail.layers_present() == 0) {
    throw Refusal(409, "the sample has no layers yet; a section needs at least one");
  }
  return view;
}

reconstruct::SectionOutline outline_of_any_size(const SampleView& view,
                                                reconstruct::SectionRequest request) {
  request.style.max_bytes = std::numeric_limits<std::int64_t>::max();
  const reconstruct::Volume& volume = view.sample.volume;
  return outline_section(volume.cuboid(), volume.bits(), request);
}

ApiResponse picture_of(const PictureTask& task, const ApiRequest& request, tbb::task_arena& arena) {
  const reconstruct::StopRequested over = time_allowed(request);
  refuse_too_large(task.outline.grid);
  const SectionRecord record = record_of(task);
  const std::vector<std::byte> file = arena.execute([&] {
    const reconstruct::Section section =
        cut_section(task.view->bricks, task.request, [&over](std::int64_t, std::int64_t) {
          reconstruct::stop_here_if(
              over, "the section took longer than " + std::to_string(kLongestAnswer) +
                        " s, or nobody waits for it any more: ask for a larger "
                        "pixel, or have it written by POST /api/v1/exports");
        });
    return encode_section_image(section.image, task.format, picture_notes(record), task.quality);
  });
  ApiResponse response{.status = 200,
                       .content_type = content_type_of(task.format),
                       .body = {reinterpret_cast<const char*>(file.data()), file.size()},
                       .headers = {}};
  response.headers[kHeader] = record_text(task, record);
  return response;
}

ApiResponse outline_of(const PictureTask& task) {
  return {.status = 200, .body = record_text(task, record_of(task))};
}

}  // namespace biotomy::acquisition
