#include "acquisition/service/focus_section.hpp"

#include "acquisition/focus/depth_of_field.hpp"
#include "acquisition/service/configuration_keys.hpp"

namespace biotomy::acquisition {
namespace {

using bridge::CheckedTable;
using bridge::Micrometres;
using bridge::TextKey;

/// 0 stands for `derived`.
Micrometres length_or(const CheckedTable& table, const char* name, Micrometres derived,
                      const char* description) {
  const Micrometres given = length(table, name, Micrometres{0.0}, description, 0.0);
  return given.value > 0.0 ? given : derived;
}

Micrometres read_depth_of_field(const CheckedTable& table, Micrometres pixel, Micrometres unknown) {
  Optics optics;
  optics.pixel = pixel;
  optics.numerical_aperture =
      number(table, "numerical_aperture", 0.0, "", 0.0, 1.0,
             "of the lens on the face's side; 0 is unknown, and the brackets find their width");
  optics.wavelength =
      length(table, "wavelength_um", optics.wavelength, "of the light, for the depth of field");
  const bool is_known = optics.numerical_aperture > 0.0;
  return length_or(table, "depth_of_field_um", is_known ? depth_of_field(optics) : unknown,
                   "0: λ/NA² + pixel/NA, or 40 without numerical_aperture; a face that leans by "
                   "more across the frame is warned of");
}

}  // namespace

FocusSettings read_focus(const CheckedTable& table, Micrometres pixel) {
  FocusSettings focus;
  focus.actuator =
      table.get(TextKey{.name = "actuator",
                        .fallback = "column",
                        .choices = {"column", "lens"},
                        .description = "what focuses: the column, or the lens of a libcamera "
                                       "camera. With a lens, positions are the distance of the "
                                       "plane in focus, 1000000 / dioptres"}) == "lens"
          ? FocusSettings::Actuator::lens
          : FocusSettings::Actuator::column;
  focus.start =
      position(table, "start_um", std::nullopt, "position around which the first search begins");
  focus.depth_of_field = read_depth_of_field(table, pixel, focus.depth_of_field);
  focus.points = count(table, "points", focus.points, 5, 1000, "of a bracket");
  focus.step = length_or(table, "step_um", 0.5 * focus.depth_of_field,
                         "between the points of the finest bracket; 0: half the depth of field");
  focus.shifts = count(table, "shifts", focus.shifts, 0, 1000,
                       "brackets after the first, in one search: moved, wider or finer");
  focus.reach =
      length(table, "reach_um", focus.reach, "no search leaves the expected position by more");
  focus.largest_change =
      length_or(table, "largest_change_um", focus.depth_of_field,
                "a peak that is off the expected position by more, a layer, is not believed, but "
                "in a first search or one that the quality ladder asks for; 0: the depth of "
                "field");
  focus.backlash = length(table, "backlash_um", focus.backlash,
                          "positions of a search are approached from below by so much", 0.0);
  focus.time_limit = duration(table, "time_limit_ms", focus.time_limit,
                              "a search that takes longer is given up", 1000);
  focus.every_layers = count(table, "every_layers", focus.every_layers, 1, 1000000,
                             "a search at the latest after so many layers, sooner while the focus "
                             "is not where it was expected; between, it follows the face");
  focus.search_below_ratio =
      number(table, "search_below_ratio", focus.search_below_ratio, "", 0.0, 10.0,
             "a search also when an accepted frame's sharpness fell below this part of the last "
             "search's peak");
  return focus;
}

}  // namespace biotomy::acquisition
