#pragma once

#include <string>
#include <vector>

#include <nlohmann/json.hpp>
#include <opencv2/core/types.hpp>

#include "reconstruct/picture/picture_notes.hpp"
#include "reconstruct/section/section.hpp"

namespace biotomy::reconstruct {

/// All that is to be known of a picture of a section: enough to find any of its pixels in the
/// sample again, and to cut it again.
struct SectionRecord {
  std::string sample;  ///< its name
  Cuboid cuboid;
  Plane plane;
  SectionOutline outline;
  cv::Size picture;         ///< pixels; larger than the outline's grid where there is a border
  cv::Point first;          ///< the picture's pixel that is the grid's pixel (0, 0)
  std::vector<int> levels;  ///< of the volume's pyramid that were read; 0 is full resolution
  nlohmann::ordered_json parameters;  ///< what was asked for, as it was asked
};

/// What is to be known of a frame of a series whose plane has no section: it misses the sample,
/// only touches it, at a corner or along an edge, or has no rectangle as it was asked for.
struct EmptyFrameRecord {
  std::string sample;
  Cuboid cuboid;
  Plane plane;
  double pixel = 0.0;  ///< of the series, micrometres
  cv::Size picture;
  nlohmann::ordered_json parameters;
};

/// The record as the sidecar file, the pictures' metadata and the HTTP API give it: `software`,
/// `sample` (`name`, `size` in voxels, `spacing_um`), `plane` (`normal`, `offset_um`),
/// `polygon_um` (vertices), `rectangle` (`origin_um`, `p`, `q`, `width_um`, `height_um`),
/// `pixel_um`, `picture` (`width`, `height`), `pixel_to_sample` and `sample_to_pixel` (matrices,
/// row by row, as PictureAffine has them), `levels`, `parameters`. Lengths are in micrometres,
/// vectors in the order x, y, z.
nlohmann::ordered_json to_json(const SectionRecord& record);

/// What there is without a section: `polygon_um` is empty; rectangle, matrices and levels are left
/// out.
nlohmann::ordered_json to_json(const EmptyFrameRecord& record);

/// What the picture's file says: the pixel size, the sample's name and the record on one line.
PictureNotes picture_notes(const SectionRecord& record);
PictureNotes picture_notes(const EmptyFrameRecord& record);

/// JSON as a file or a picture's metadata holds it: ASCII, whatever letters names are written in.
/// Without an indentation it is one line.
std::string json_text(const nlohmann::ordered_json& document, int indentation = -1);

}  // namespace biotomy::reconstruct
