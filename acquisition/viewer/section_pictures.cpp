#include "acquisition/viewer/section_pictures.hpp"

#include <limits>
#include <string>
#include <utility>

#include "acquisition/viewer/refusal.hpp"
#include "acquisition/viewer/section_query.hpp"
#include "acquisition/viewer/time_allowed.hpp"
#include "reconstruct/section/level_choice.hpp"
#include "reconstruct/section/section_record.hpp"

namespace biotomy::acquisition {
namespace {

using nlohmann::ordered_json;
using reconstruct::SectionOutline;
using reconstruct::SectionRecord;
using reconstruct::SectionRequest;

constexpr const char* kHeader = "Biotomy-Section";

/// A section that was asked for, made to fit, and where it lies.
struct Planned {
  std::shared_ptr<const SampleView> view;
  SectionQuery asked;
  SectionQuery fitted;
  SectionRequest request;  ///< of the fitted one
  SectionOutline outline;
};

Planned plan(LiveSample& live, const Query& query) {
  SectionQuery asked = section_query(query);
  std::shared_ptr<const SampleView> view = look_at_layers(live);
  const reconstruct::Volume& volume = view->sample.volume;
  SectionQuery smaller = fitted(asked, volume.cuboid(), volume.bits());
  SectionRequest request = section_request(smaller, volume.cuboid());
  request.style.max_bytes = std::numeric_limits<std::int64_t>::max();
  SectionOutline outline = outline_section(volume.cuboid(), volume.bits(), request);
  return {std::move(view), std::move(asked), std::move(smaller), request, std::move(outline)};
}

SectionRecord record_of(const Planned& planned) {
  const reconstruct::LevelChoice levels = reconstruct::level_choice(
      planned.view->bricks, planned.outline.grid.pixel, planned.request.style.interpolation);
  const reconstruct::OpenedSample& sample = planned.view->sample;
  return {
      sample.folder.description().name,
      sample.volume.cuboid(),
      planned.request.plane,
      planned.outline,
      {planned.outline.grid.columns, planned.outline.grid.rows},
      {0, 0},
      levels.part == 0.0 ? std::vector{levels.finer} : std::vector{levels.finer, levels.finer + 1},
      section_command_parameters(planned.fitted)};
}

/// The picture of what was asked, were it not made to fit.
ordered_json full_json(const Planned& planned) {
  const reconstruct::Volume& volume = planned.view->sample.volume;
  SectionRequest request = section_request(planned.asked, volume.cuboid());
  request.style.max_bytes = std::numeric_limits<std::int64_t>::max();
  const reconstruct::PixelGrid grid = outline_section(volume.cuboid(), volume.bits(), request).grid;
  return {{"pixel_um", grid.pixel}, {"width", grid.columns}, {"height", grid.rows}};
}

/// As SectionRecord's JSON, and what a page needs beside it.
std::string record_text(const Planned& planned, const SectionRecord& record) {
  ordered_json document = to_json(record);
  const std::filesystem::path& folder = planned.view->sample.folder.path();
  document["full"] = full_json(planned);
  document["command"] = section_command(planned.asked, folder);
  document["command_here"] = section_command(planned.fitted, folder);
  document["layers_present"] = planned.view->sample.tail.layers_present();
  document["generation"] = planned.view->generation;
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

ApiResponse SectionPictures::picture(const ApiRequest& request) const {
  const reconstruct::StopRequested over = time_allowed(request);
  const Planned planned = plan(live_, request.query);
  refuse_too_large(planned.outline.grid);
  const reconstruct::PictureFormat format = format_of(planned.asked.format);
  const int quality = reconstruct::parse_quality("quality", planned.asked.quality);
  const SectionRecord record = record_of(planned);
  const std::vector<std::byte> file = arena_.execute([&] {
    const reconstruct::Section section =
        cut_section(planned.view->bricks, planned.request, [&over](std::int64_t, std::int64_t) {
          reconstruct::stop_here_if(
              over, "the section took longer than " + std::to_string(kLongestAnswer) +
                        " s, or nobody waits for it any more: ask for a larger "
                        "pixel, or have it written by POST /api/v1/exports");
        });
    return encode_section_image(section.image, format, picture_notes(record), quality);
  });
  ApiResponse response{.status = 200,
                       .content_type = content_type_of(format),
                       .body = {reinterpret_cast<const char*>(file.data()), file.size()},
                       .headers = {}};
  response.headers[kHeader] = record_text(planned, record);
  return response;
}

ApiResponse SectionPictures::outline(const ApiRequest& request) const {
  const Planned planned = plan(live_, request.query);
  return {.status = 200, .body = record_text(planned, record_of(planned))};
}

}  // namespace biotomy::acquisition
