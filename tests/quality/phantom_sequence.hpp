#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "sim/phantom/phantom.hpp"
#include "sim/physics/block.hpp"
#include "sim/physics/camera.hpp"
#include "tests/quality/drawn_numbers.hpp"
#include "tests/quality/labelled_frame.hpp"

namespace biotomy::tests {

/// How a specimen is ground and photographed.
struct SequenceSettings {
  std::uint64_t seed = 1;
  int width = 1600;
  int height = 1200;
  int layers = 30;
  double layer_um = 20.0;
  double pixel_um = 10.0;
  bool mosaic = false;            ///< the camera has one chip: see sim::interpolate_mosaic
  double detail_pixels = 3.5;     ///< the specimen's finest detail
  double depth_layers = 50.0;     ///< over so many layers the anatomy changes markedly
  double begins_at_layer = -1e6;  ///< before it there is casting alone
  double ends_at_layer = 1e6;     ///< and after it
  double end_layers = 15.0;       ///< from an end to where the specimen is as wide as it gets

  int defects_per_layer = 3;
  int first_defect_layer = 6;  ///< by then the daemon knows what is usual here
  int focus_period = 10;       ///< layers from one focus bracket to the next
};

/// The frames of one layer.
struct LabelledLayer {
  int layer = 0;  ///< from 1
  std::optional<bridge::Frame>
      bracket{};  ///< the sharpest frame of a focus bracket, if one was made
  std::vector<LabelledFrame> defective{};  ///< each as if it were the first frame of the layer
  LabelledFrame good{};                    ///< the one that is accepted
};

/// A run of the twin without its rig: layer after layer of one specimen, each photographed well and
/// with defects, by the twin's own optics, sensor and surface. The same settings give the same
/// frames. One layer is in memory at a time. One thread at a time.
///
/// Well means: out of focus by at most 14 µm, a quarter of the depth of field λ/NA² of the twin's
/// lens; the lamp within 1 % of what it slowly drifts to, at most 0.1 % a layer; the block within
/// 0.4 pixel of its place.
class PhantomSequence {
 public:
  explicit PhantomSequence(const SequenceSettings& settings);

  /// Nothing after the last layer.
  std::optional<LabelledLayer> next();

 private:
  struct Setting {
    sim::Scene scene;
    double smear_pixels = 0.0;
    double defocus_um = 0.0;
    double exposure = 1.0;  ///< of the nominal exposure
  };

  Setting well(const sim::Block& block);
  bridge::Frame photograph(const Setting& setting);
  double contrast(const Setting& setting) const;
  double strength_of(const DefectKind& kind);
  Defect next_defect();
  LabelledFrame defective(Defect defect, const sim::Block& clean, const sim::Block& dirty);
  LabelledFrame unchanged();
  cv::Mat part_of_frame(double share);
  void shade(cv::Mat& image, double part);
  void spoil(LabelledFrame& made);

  SequenceSettings settings_;
  DrawnNumbers drawn_;
  sim::Phantom phantom_;
  sim::CameraOptics optics_;
  sim::Camera camera_;
  sim::Block block_;
  sim::Displacement displacement_{};
  double focus_drift_um_;  ///< a layer
  double lamp_drift_;      ///< a layer
  std::vector<Defect> to_come_;
  int layer_ = 0;
  bridge::Frame accepted_;  ///< of the layer before
};

}  // namespace biotomy::tests
