#pragma once

#include <optional>
#include <span>
#include <vector>

#include "acquisition/focus/focus_map.hpp"

namespace biotomy::acquisition {

/// What a bracket tells of the focus.
struct BracketVerdict {
  enum class Kind {
    peak,    ///< it lies inside, and a parabola fits
    lower,   ///< the detail grows towards the first position
    higher,  ///< towards the last
    flat,    ///< the detail changes too little against its noise
    rough,   ///< the greatest detail is inside, but the curve is no parabola
  } kind = Kind::flat;
  bridge::Micrometres position{};  ///< of the peak, else of the greatest detail
  double most = 0.0;               ///< the greatest logarithm of detail that was measured
  double drop = 0.0;               ///< of the logarithm, from the greatest to the least
  double curvature = 0.0;          ///< of a peak, per squared step of the bracket
  double uncertainty = 0.0;        ///< of a logarithm: by noise, and by what the parabola leaves
  std::vector<std::size_t> tiles;  ///< that tell; the logarithms are of their detail
  std::optional<FocusMap> map;     ///< of a peak, where enough tiles show detail
};

/// `bracket` holds at least four frames at equal distances in growing order.
///
/// A peak is believed when it lies half a step or more inside, noise moves it by less than a
/// twentieth of a step (standard deviation), and the parabola explains nine tenths of the curve's
/// variance or leaves no more than noise. It is then taken from the map's plane, which no single
/// part of the face can pull away, if that plane is as certain and near; else from the parabola of
/// the whole.
BracketVerdict judge_bracket(std::span<const BracketFrame> bracket);

/// The logarithm of the detail of a frame's `tiles`, with its standard deviation by noise; nothing
/// where there is no more than noise.
struct DetailLevel {
  double logarithm = 0.0;
  double error = 0.0;
};
std::optional<DetailLevel> detail_level(const FrameMeasures& measures,
                                        std::span<const std::size_t> tiles);

}  // namespace biotomy::acquisition
