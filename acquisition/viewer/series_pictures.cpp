#include "acquisition/viewer/series_pictures.hpp"

#include <algorithm>
#include <utility>

#include "acquisition/viewer/request_text.hpp"
#include "acquisition/viewer/series_query.hpp"
#include "acquisition/viewer/time_allowed.hpp"
#include "reconstruct/geometry/section_polygon.hpp"
#include "reconstruct/interruption.hpp"
#include "reconstruct/section/section_record.hpp"

namespace biotomy::acquisition {
namespace {

using nlohmann::ordered_json;
using reconstruct::SeriesFrame;

bool cuts(const SeriesFrame& frame, const reconstruct::Cuboid& cuboid) {
  return contact(frame.plane, cuboid).vertices.size() >= 3;
}

/// What two requests for frames of the same series have in common.
std::string key_of(Query query, const SampleView& view) {
  for (const char* of_one : {"index", "format", "quality", "v", "generation"}) query.erase(of_one);
  std::string key = view.sample.folder.description().created + '\n';
  for (const auto& [name, value] : query) key.append(name).append("=").append(value).append("\n");
  return key;
}

}  // namespace

struct SeriesPictures::Plan {
  reconstruct::Series series;
  std::string pixel;  ///< as the parameter has it, with which all frames fit
};

std::shared_ptr<const SeriesPictures::Plan> SeriesPictures::plan(const ApiRequest& request,
                                                                 const SampleView& view) const {
  const Query& query = request.query;
  const std::string key = key_of(query, view);
  {
    const std::lock_guard lock(mutex_);
    if (const auto* found = plans_.find(key); found != nullptr) return *found;
  }
  const SeriesQuery asked = series_query(query, {"index"});
  const reconstruct::Cuboid& cuboid = view.sample.volume.cuboid();
  auto made = std::make_shared<Plan>(Plan{series_of(asked, cuboid), asked.style.parameters.pixel});
  if (asked.style.fit) {
    const reconstruct::SectionStyle style = style_of(asked, cuboid);
    const reconstruct::StopRequested over = time_allowed(request);
    double least = 0.0;
    for (const SeriesFrame& frame : made->series.frames) {
      reconstruct::stop_here_if(over,
                                "the series has too many frames to find out what fits all: "
                                "make its step larger, or give a pixel");
      if (!cuts(frame, cuboid)) continue;
      const reconstruct::PixelGrid grid =
          outline_of_any_size(view, {frame.plane, frame.basis, style}).grid;
      if (grid.columns > asked.style.fit->width || grid.rows > asked.style.fit->height) {
        least = std::max(least, pixel_to_fit(grid.rectangle, *asked.style.fit));
      }
    }
    if (least > 0.0) {
      made->pixel = with_pixel(asked.style, least, cuboid.spacing).parameters.pixel;
    }
  }
  const std::lock_guard lock(mutex_);
  plans_.put(key, made, 1);
  return made;
}

ApiResponse SeriesPictures::frames(const ApiRequest& request) const {
  const auto view = live_.look();
  ApiRequest asked = request;
  asked.query.erase("fit");  // changes no plane, and takes a look at every frame
  const auto made = plan(asked, *view);
  ordered_json frames = ordered_json::array();
  for (std::size_t i = 0; i < made->series.frames.size(); ++i) {
    const SeriesFrame& frame = made->series.frames[i];
    const reconstruct::Vector3& normal = frame.plane.normal();
    frames.push_back(
        {{"index", i},
         {"value", frame.value},
         {"label", frame_label(made->series, i)},
         {"cuts", cuts(frame, view->sample.volume.cuboid())},
         {"plane",
          {{"normal", {normal.x, normal.y, normal.z}}, {"offset_um", frame.plane.offset()}}}});
  }
  return {.status = 200,
          .body = reconstruct::json_text({{"unit", made->series.unit}, {"frames", frames}})};
}

PictureTask SeriesPictures::frame_task(const ApiRequest& request) const {
  const Query& query = request.query;
  std::shared_ptr<const SampleView> view = look_at_layers(live_);
  const auto made = plan(request, *view);
  const auto index = query.find("index");
  const auto number = index == query.end()
                          ? std::nullopt
                          : whole_number(index->second, 0,
                                         static_cast<std::int64_t>(made->series.frames.size()) - 1);
  if (!number) {
    throw reconstruct::InvalidRequest("index must be the number of a frame, 0 to " +
                                      std::to_string(made->series.frames.size() - 1));
  }
  const SeriesQuery asked = series_query(query, {"index"});
  SeriesQuery smaller = asked;
  smaller.style.parameters.pixel = made->pixel;
  const reconstruct::Cuboid& cuboid = view->sample.volume.cuboid();
  const std::filesystem::path& folder = view->sample.folder.path();
  const SeriesFrame& frame = made->series.frames[static_cast<std::size_t>(*number)];
  const reconstruct::SectionRequest section{frame.plane, frame.basis, style_of(smaller, cuboid)};
  PictureTask task{
      .view = nullptr,
      .request = section,
      .outline = outline_of_any_size(*view, section),
      .full = outline_of_any_size(*view, {frame.plane, frame.basis, style_of(asked, cuboid)}).grid,
      .format = format_of(asked.style.format),
      .quality = reconstruct::parse_quality("quality", asked.style.quality),
      .parameters = series_command_parameters(smaller),
      .command = series_command(asked, folder),
      .command_here = series_command(smaller, folder)};
  task.view = std::move(view);
  return task;
}

}  // namespace biotomy::acquisition
