#pragma once

#include <cstdint>

#include <opencv2/core/mat.hpp>

#include "sim/physics/defocus.hpp"
#include "sim/physics/face_painter.hpp"
#include "sim/physics/face_tilt.hpp"
#include "sim/physics/lamp_field.hpp"
#include "sim/physics/sensor.hpp"
#include "sim/physics/surface_film.hpp"

namespace biotomy::sim {

/// What the camera needs to know of the rig at one moment.
struct Scene {
  Block block;
  double traverse_um = 0;
  double column_um = 0;
  bool lamp_on = false;
  double lamp_share = 1;       ///< of the light that the lamp should give
  double vibration_mm_s = 0;   ///< RMS velocity of camera against block
  double column_scale_um = 0;  ///< what the column's scale shows
  LampField lamp_field{};
  SurfaceFilm film{};
  Displacement displacement{};  ///< of the block in its holder
};

struct CameraOptics {
  View view{};
  Lens lens{};
  /// The focal plane lies at the feed coordinate column + offset. Nobody but the twin knows it:
  /// the daemon has to find it by focusing.
  double column_offset_um = 350;
  FaceTilt tilt{};
};

struct Photograph {
  cv::Mat image;  ///< CV_8UC3 or CV_16UC3, R, G, B
  std::uint64_t number = 0;
  double defocus_um = 0;  ///< face − focal plane, in the middle of exposure and frame
  bool face_in_view = false;
};

/// The camera above the parked block. One thread at a time.
class Camera {
 public:
  Camera(std::uint64_t seed, const Phantom& phantom, double first_face_um,
         const CameraOptics& optics, const SensorSettings& sensor);

  /// A photograph whose exposure began at one scene and ended at the other. A block that is not
  /// quite parked is out of place, one that moved is smeared, one that is elsewhere leaves the
  /// empty bed.
  Photograph take(const Scene& begin, const Scene& end, const ExposureSettings& exposure);

  const View& view() const { return optics_.view; }

 private:
  bool place_face(double traverse_um, const cv::Mat& face, cv::Mat& light) const;

  std::uint64_t seed_;
  CameraOptics optics_;
  FacePainter painter_;
  Sensor sensor_;
  std::uint64_t photographs_ = 0;
};

}  // namespace biotomy::sim
