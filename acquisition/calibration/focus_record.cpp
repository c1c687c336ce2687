#include "acquisition/calibration/focus_record.hpp"

#include <array>
#include <cstdio>

#include <nlohmann/json.hpp>

#include "acquisition/calibration/calibration_file.hpp"
#include "acquisition/focus/face_lean_json.hpp"

namespace biotomy::acquisition {
namespace {

using nlohmann::ordered_json;

ordered_json points_json(const std::vector<FocusRow::Point>& points) {
  ordered_json list = ordered_json::array();
  for (const FocusRow::Point& point : points) {
    list.push_back({{"plane_um", point.column.value}, {"sharpness", point.sharpness}});
  }
  return list;
}

std::string lean_text(const std::optional<FaceLean>& lean) {
  if (!lean) return "too little of it shows detail to tell how it leans";
  std::array<char, 120> text{};
  std::snprintf(text.data(), text.size(),
                "it leans by %.2f°, %.0f µm across the frame and %.0f µm down it",
                lean->angle_degrees, lean->across.value, lean->down.value);
  return text.data();
}

}  // namespace

void write_focus_record(const std::filesystem::path& folder, const FocusRecord& record) {
  write_calibration_file(folder, "focus.json",
                         {{"kind", "focus"},
                          {"found_at", record.found_at},
                          {"actuator", record.actuator},
                          {"position", record.position},
                          {"plane_um", record.plane.value},
                          {"suitable_step_um", record.step.value},
                          {"depth_of_field_um", record.depth_of_field.value},
                          {"lean", lean_json(record.lean)},
                          {"points", points_json(record.points)},
                          {"taken_with", taken_with(record.settings)}});
}

std::string sentence_of(const FocusRecord& record) {
  std::array<char, 40> start{};
  std::snprintf(start.data(), start.size(), "%.1f", record.plane.value);
  return "the face is sharpest at " + record.position + " of the " + record.actuator +
         ": set focus.start_um = " + start.data() + "; " + lean_text(record.lean);
}

}  // namespace biotomy::acquisition
