#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace biotomy::tests {

/// What a run of layers is like for whoever has to keep it in focus.
struct FocusCourse {
  std::string name;
  std::uint64_t seed = 1;
  int layers = 200;
  double layer_thickness_um = 20.0;
  double specimen_um = 4800.0;  ///< its picture's width; the view is 4.8 mm wide, from a corner on
  double content_um = 640.0;    ///< of depth, over which the anatomy changes markedly
  double tilt_across_um = 0.0;  ///< the face lies so much deeper at the right edge of the frame
  double tilt_down_um = 0.0;
  double backlash_um = 12.0;    ///< of the column, or of the lens
  double drift_um = 0.5;        ///< of the focal plane, a layer
  double wander_um = 0.5;       ///< its standard deviation from one layer to the next
  double swing_um = 60.0;       ///< and how far the day's warmth moves it, up and down …
  double swing_layers = 200.0;  ///< … within so many layers
  double knock_um = 0.0;        ///< by which something moves the column half-way through
  double gain = 1.0;            ///< of the camera, with so much less light: its noise
  bool lens = false;            ///< focused by a lens in place of the column
  bool mosaic = false;          ///< the camera has one chip: see sim::interpolate_mosaic
};

/// The courses of the proof: several phantoms, tilted and level faces, little and much light, fast
/// content, faces that are nearly empty; the column, and a lens.
std::vector<FocusCourse> focus_courses();

/// How a course went.
struct FocusOutcome {
  std::string name;
  int searches = 0;
  int found = 0;
  int focus_frames = 0;           ///< that the searches took
  int taken_again = 0;            ///< frames that were blurred, so that the focus was searched anew
  int most_frames = 0;            ///< in one search
  double farthest_um = 0.0;       ///< that a search went from where the face was
  std::vector<double> misses_um;  ///< of each layer's frame: face − focal plane
};

/// The depth of field of the courses' lens by diffraction alone, λ/NA²: the strictest of all.
double course_depth_of_field_um();

/// Runs the daemon's focus step over a course, on the twin's physics, in this process.
FocusOutcome run(const FocusCourse& course);

}  // namespace biotomy::tests
