#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <vector>

#include "acquisition/quality/casting.hpp"
#include "acquisition/quality/light_change.hpp"
#include "acquisition/quality/surface_print.hpp"

namespace biotomy::acquisition {

/// The light in which a frame was taken, as it was found.
struct FrameLight {
  MeasuredLight measured{};   ///< against the last accepted layer's
  LightChange since_first{};  ///< against the record's first layer, by way of all between
  std::optional<CastingColour> casting{};  ///< as the frame shows it
};

/// What the surface of a new face is compared with: the last accepted layer's, the light and the
/// colours of the layers before it, and the first layer's casting material. Cheap to copy.
class SurfaceRecord {
 public:
  /// So many layers' light and colours are remembered.
  static constexpr std::size_t kRemembered = 8;

  /// The layer is accepted and stored. `light` is what it was found to have been taken in,
  /// `arrived` the part of it in which new tissue came up.
  void accept(std::int64_t layer, std::shared_ptr<const SurfacePrint> surface,
              const FrameLight& light, double arrived = 0.0);

  /// The colour of the first layer's casting material, known from the journal, before any `accept`.
  void recall(const CastingColour& first) { first_casting_ = first; }

  std::int64_t layer() const { return layer_; }  ///< whose surface it is; 0 for none
  const SurfacePrint* surface() const { return surface_.get(); }

  double arrived() const { return arrived_; }  ///< in the last layer

  /// Of the last layers, at least one once there is a surface.
  const std::vector<std::shared_ptr<const SurfaceColours>>& colours() const { return colours_; }

  /// The light of the last layer, and the median of the last layers' light, against the first's.
  LightChange last_light() const;
  LightChange usual_light() const;
  /// The greatest errors with which the light of the last layers was measured.
  double level_error() const;
  double range_error() const;

  const std::optional<CastingColour>& casting() const { return casting_; }  ///< as seen last
  const std::optional<CastingColour>& first_casting() const { return first_casting_; }

 private:
  std::int64_t layer_ = 0;
  std::shared_ptr<const SurfacePrint> surface_;
  double arrived_ = 0.0;
  std::vector<std::shared_ptr<const SurfaceColours>> colours_;
  std::deque<FrameLight> lights_;
  std::optional<CastingColour> casting_;
  std::optional<CastingColour> first_casting_;
};

}  // namespace biotomy::acquisition
