#include "reconstruct/section/section_record.hpp"

#include <cstddef>

#include "reconstruct/section/picture_affine.hpp"

namespace biotomy::reconstruct {
namespace {

using nlohmann::ordered_json;

ordered_json vector_json(const Vector3& v) {
  return {v.x, v.y, v.z};
}

ordered_json sample_json(const std::string& name, const Cuboid& cuboid) {
  const GridSize& size = cuboid.size;
  return {{"name", name},
          {"size", {size.x, size.y, size.z}},
          {"spacing_um", vector_json(cuboid.spacing)}};
}

ordered_json plane_json(const Plane& plane) {
  return {{"normal", vector_json(plane.normal())}, {"offset_um", plane.offset()}};
}

template <typename Matrix>
ordered_json matrix_json(const Matrix& matrix) {
  ordered_json rows = ordered_json::array();
  for (const auto& row : matrix) {
    rows.push_back(ordered_json(row));
  }
  return rows;
}

}  // namespace

ordered_json to_json(const SectionRecord& record) {
  const PixelGrid& grid = record.outline.grid;
  const ThetaRectangle& rectangle = grid.rectangle;
  const PictureAffine affine = picture_affine(grid, record.plane, record.first.x, record.first.y);
  ordered_json polygon = ordered_json::array();
  for (const Vector3& vertex : record.outline.polygon) {
    polygon.push_back(vector_json(vertex));
  }
  return {
      {"software", "Biotomy " BIOTOMY_VERSION},
      {"sample", sample_json(record.sample, record.cuboid)},
      {"plane", plane_json(record.plane)},
      {"polygon_um", polygon},
      {"rectangle",
       {{"origin_um", vector_json(rectangle.origin)},
        {"p", vector_json(rectangle.axes.p)},
        {"q", vector_json(rectangle.axes.q)},
        {"width_um", rectangle.width},
        {"height_um", rectangle.height}}},
      {"pixel_um", grid.pixel},
      {"picture", {{"width", record.picture.width}, {"height", record.picture.height}}},
      {"pixel_to_sample", matrix_json(affine.pixel_to_sample)},
      {"sample_to_pixel", matrix_json(affine.sample_to_pixel)},
      {"levels", record.levels},
      {"parameters", record.parameters},
  };
}

ordered_json to_json(const EmptyFrameRecord& record) {
  return {
      {"software", "Biotomy " BIOTOMY_VERSION},
      {"sample", sample_json(record.sample, record.cuboid)},
      {"plane", plane_json(record.plane)},
      {"polygon_um", ordered_json::array()},
      {"pixel_um", record.pixel},
      {"picture", {{"width", record.picture.width}, {"height", record.picture.height}}},
      {"parameters", record.parameters},
  };
}

PictureNotes picture_notes(const SectionRecord& record) {
  return {record.outline.grid.pixel, record.sample, json_text(to_json(record))};
}

PictureNotes picture_notes(const EmptyFrameRecord& record) {
  return {record.pixel, record.sample, json_text(to_json(record))};
}

std::string json_text(const ordered_json& document, int indentation) {
  // Parameters come from a command line, which need not be UTF-8.
  return document.dump(indentation, ' ', true, ordered_json::error_handler_t::replace);
}

}  // namespace biotomy::reconstruct
