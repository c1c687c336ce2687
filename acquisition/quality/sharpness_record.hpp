#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "acquisition/quality/camera_noise.hpp"
#include "acquisition/quality/frame_measures.hpp"

namespace biotomy::acquisition {

/// What a frame's sharpness is compared with: the last accepted layers, and the sharpest frame of
/// the last focus search; and what is known of the camera's noise, by which all of them are
/// expressed, whatever was known when they were measured. Cheap to copy.
class SharpnessRecord {
 public:
  /// Layers that are remembered: the fewest of which a median leaves an odd one out. More would be
  /// less alike: on the twin's layers the ratio to eight of them scatters by a quarter more.
  static constexpr std::size_t kRemembered = 3;

  using Frame = std::shared_ptr<const FrameMeasures>;

  void accept(Frame frame);

  /// The sharpest frame of a search at `layer`.
  void found_focus(std::int64_t layer, Frame peak);

  void know_noise(const CameraNoise& noise);

  /// These measures by the noise that is known; as they are, while none is.
  Frame expressed(Frame frame) const;

  const std::vector<Frame>& recent() const { return recent_; }
  const Frame& peak() const { return peak_; }  ///< none before the first search
  std::int64_t peak_layer() const { return peak_layer_; }
  const std::optional<CameraNoise>& noise() const { return noise_; }
  /// Of face prints; nothing when it is not known, or white, as the prints themselves tell it.
  std::optional<BandNoise> noise_of_faces() const;

 private:
  std::vector<Frame> recent_;
  Frame peak_;
  std::int64_t peak_layer_ = 0;
  std::optional<CameraNoise> noise_;
};

}  // namespace biotomy::acquisition
