#include "acquisition/viewer/exports/export_order.hpp"

#include <algorithm>
#include <exception>

#include <nlohmann/json.hpp>

#include "acquisition/viewer/command_line.hpp"
#include "acquisition/viewer/picture_task.hpp"
#include "reconstruct/errors.hpp"
#include "reconstruct/excerpt.hpp"
#include "reconstruct/section/film.hpp"
#include "reconstruct/section/series_layout.hpp"

namespace biotomy::acquisition {
namespace {

using nlohmann::json;
using reconstruct::InvalidRequest;
using reconstruct::PictureFormat;

constexpr std::size_t kFramesLookedAt = 64;  // for the size of the largest
constexpr double kLeastRate = 1.0;
constexpr double kMostRate = 120.0;
constexpr double kPartOfJpeg = 0.5;  // of the pixels' bytes: more than a JPEG of tissue takes
constexpr double kPartOfFilm = 0.1;

constexpr std::array<std::string_view, 7> kKnown = {"kind",  "format", "parameters", "series",
                                                    "movie", "frames", "rate"};

/// Texts as a query has them; numbers as JSON writes them.
void take_all(const json& body, const char* name, Query& query) {
  if (!body.contains(name)) return;
  const json& object = body.at(name);
  if (!object.is_object()) throw InvalidRequest(std::string(name) + " must be an object");
  for (const auto& [key, value] : object.items()) {
    if (!value.is_string() && !value.is_number()) {
      throw InvalidRequest(std::string(name) + '.' + reconstruct::excerpt(key) +
                           " must be a text or a number");
    }
    query[key] = value.is_string() ? value.get<std::string>() : value.dump();
  }
}

bool flag(const json& body, const char* name, bool fallback) {
  if (!body.contains(name)) return fallback;
  if (!body.at(name).is_boolean()) {
    throw InvalidRequest(std::string(name) + " must be true or false");
  }
  return body.at(name).get<bool>();
}

std::string text(const json& body, const char* name) {
  if (!body.contains(name) || !body.at(name).is_string()) {
    throw InvalidRequest(std::string(name) + " must be a text");
  }
  return body.at(name).get<std::string>();
}

double rate_of(const json& body) {
  if (!body.contains("rate")) return ExportOrder{}.rate;
  const double rate = body.at("rate").is_number() ? body.at("rate").get<double>() : 0.0;
  if (rate < kLeastRate || rate > kMostRate) {
    throw InvalidRequest("rate must be a number of frames in a second, 1 to 120");
  }
  return rate;
}

json parsed(const std::string& body) {
  json document = json::parse(body, nullptr, false);
  if (!document.is_object()) throw InvalidRequest("the body must be a JSON object");
  Query names;
  for (const auto& [name, value] : document.items()) names[name] = "";
  refuse_unknown(names, kKnown);
  return document;
}

std::uint64_t bytes_on_disk(double pixel_bytes, PictureFormat format) {
  return static_cast<std::uint64_t>(pixel_bytes *
                                    (format == PictureFormat::jpeg ? kPartOfJpeg : 1.0));
}

double bytes_of_colour(const reconstruct::Volume& volume) {
  return volume.bits() == 16 ? 2.0 : 1.0;
}

ExportPlan section_plan(const SectionQuery& query, const SampleView& view, std::int64_t max_bytes) {
  const reconstruct::Volume& volume = view.sample.volume;
  reconstruct::SectionRequest request = section_request(query, volume.cuboid());
  request.style.max_bytes = max_bytes;
  const reconstruct::PixelGrid grid = outline_section(volume.cuboid(), volume.bits(), request).grid;
  const double bytes = static_cast<double>(grid.columns) * grid.rows * 3 * bytes_of_colour(volume);
  return {grid.rows, "rows", bytes_on_disk(bytes, format_of(query.format)),
          section_command(query, view.sample.folder.path())};
}

ExportPlan series_plan(const ExportOrder& order, const SampleView& view, std::int64_t max_bytes) {
  const reconstruct::Volume& volume = view.sample.volume;
  const SeriesQuery& query = *order.series;
  const reconstruct::Series series = series_of(query, volume.cuboid());
  const std::size_t count = series.frames.size();
  reconstruct::SectionStyle style = style_of(query, volume.cuboid());
  style.max_bytes = max_bytes;
  double width = 0.0;
  double height = 0.0;
  std::exception_ptr refusal;
  const std::size_t step = std::max<std::size_t>(count / kFramesLookedAt, 1);
  for (std::size_t i = 0; i < count; i += step) {
    const reconstruct::SeriesFrame& frame = series.frames[i];
    const reconstruct::FrameOutline looked_at =
        frame_outline(frame, volume.cuboid(), volume.bits(), style);
    if (!looked_at.outline) {
      refusal = looked_at.refusal;
      continue;
    }
    width = std::max<double>(width, looked_at.outline->grid.columns);
    height = std::max<double>(height, looked_at.outline->grid.rows);
  }
  if (width == 0.0 && refusal) std::rethrow_exception(refusal);
  const double pixel_bytes = width * height * 3 * static_cast<double>(count);
  std::uint64_t bytes = 0;
  if (order.frames) {
    bytes += bytes_on_disk(pixel_bytes * bytes_of_colour(volume), format_of(query.style.format));
  }
  if (order.movie) bytes += static_cast<std::uint64_t>(kPartOfFilm * pixel_bytes);
  const json rate = order.rate;
  return {static_cast<std::int64_t>(count), "frames", bytes,
          series_command(query, view.sample.folder.path(), order.movie, rate.dump())};
}

}  // namespace

ExportOrder export_order(const std::string& body) {
  const json document = parsed(body);
  const std::string kind = text(document, "kind");
  if (kind != "section" && kind != "series") {
    throw InvalidRequest("kind '" + reconstruct::excerpt(kind) + "': there are section and series");
  }
  Query query;
  take_all(document, "parameters", query);
  if (query.contains("fit")) {
    throw InvalidRequest("fit: an export is of full resolution, or of the pixel that is asked for");
  }
  query["format"] = document.contains("format") ? text(document, "format") : "png";
  ExportOrder order;
  if (kind == "section") {
    if (document.contains("series") || flag(document, "movie", false)) {
      throw InvalidRequest("a section is no series, and has no movie");
    }
    order.section = section_query(query);
    return order;
  }
  take_all(document, "series", query);
  order.series = series_query(query);
  order.frames = flag(document, "frames", true);
  order.movie = flag(document, "movie", false);
  order.rate = rate_of(document);
  if (!order.frames && !order.movie) {
    throw InvalidRequest("a series without frames and without a movie has nothing to export");
  }
  return order;
}

ExportPlan export_plan(const ExportOrder& order, const SampleView& view, std::int64_t max_bytes) {
  return order.section ? section_plan(*order.section, view, max_bytes)
                       : series_plan(order, view, max_bytes);
}

}  // namespace biotomy::acquisition
