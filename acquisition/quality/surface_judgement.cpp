#include "acquisition/quality/surface_judgement.hpp"

#include <algorithm>
#include <cstddef>
#include <string>

#include "acquisition/quality/surface_defects.hpp"

namespace biotomy::acquisition {
namespace {

/// Where tissue comes up over larger areas some of it has, in small places, colours of its own:
/// this part of the area.
constexpr double kNewPerArrived = 0.04;

/// So many cells of a thumbnail have a colour of their own by chance.
constexpr double kCellsByChance = 4.0;

/// In a smaller frame a cell or two are more of it than the limit.
constexpr std::size_t kLeastCells = 200;

void judge_shift(const SurfacePrint& now, const SurfaceRecord& surfaces,
                 const QualityThresholds& thresholds, Judgement& judgement) {
  const std::optional<Shift> shift = measure_shift(now.border, surfaces.surface()->border);
  if (!shift) {
    judgement.leave_open("too little grain to tell where the block lies beside layer " +
                         std::to_string(surfaces.layer()) + "'s");
    return;
  }
  const std::string moved =
      "the block lies %.2f pixels beside where it lay in layer " +
      std::to_string(surfaces.layer()) +
      ", more than %.2f: it came loose or is not parked; if it may stay so, raise "
      "quality.maximum_shift for one layer";
  judgement.at_most("shift", shift->length(), thresholds.maximum_shift, "shifted", moved.c_str());
  judgement.within("shift_x", shift->x, thresholds.maximum_shift, "shifted", moved.c_str());
  judgement.within("shift_y", shift->y, thresholds.maximum_shift, "shifted", moved.c_str());
}

}  // namespace

void judge_surface(const cv::Mat& image, const ClippingLevels& clipping,
                   const SurfaceRecord& surfaces, const QualityThresholds& thresholds,
                   Judgement& judgement) {
  const SurfacePrint& now = *judgement.result().surface;
  const SurfacePrint* before = surfaces.surface();
  if (before == nullptr || now.thumbnail.empty() ||
      before->thumbnail.size() != now.thumbnail.size()) {
    return;
  }
  judge_shift(now, surfaces, thresholds, judgement);
  const SurfaceDefects found = find_surface_defects(image, clipping, now, surfaces,
                                                    judgement.result().light.measured.change);
  judgement.at_most("glare", found.glare, thresholds.maximum_glare, "glare",
                    "%.4f of the frame is glare, more than %.4f: ice or liquid reflects the lamp");
  judgement.at_most("frost", found.frost, thresholds.maximum_frost, "frost",
                    "%.4f of the frame is under a whitish veil, more than %.4f: frost on the face");
  if (now.light.total() >= kLeastCells) {
    judgement.at_most("shade", found.shade, thresholds.maximum_shade, "shaded",
                      "%.3f of the frame is darker or brighter than its light is, more than %.3f: "
                      "something stands in the light or before the lens");
  }
  judgement.result().arrived = found.arrived;
  // It goes on coming up in the next layer, be it in small places alone.
  const double arrives = std::max(found.arrived, surfaces.arrived());
  const double by_chance = kCellsByChance / static_cast<double>(now.thumbnail.total());
  judgement.at_most("debris", found.debris,
                    thresholds.maximum_debris + kNewPerArrived * arrives + by_chance, "debris",
                    "%.4f of the frame has colours that the layers before have nowhere near, more "
                    "than %.4f: debris on the face");
}

}  // namespace biotomy::acquisition
