#include "acquisition/quality/focus_sweep.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include <opencv2/core.hpp>

#include "acquisition/quality/median.hpp"
#include "acquisition/quality/shared_detail.hpp"
#include "acquisition/quality/sweep_mask.hpp"
#include "acquisition/quality/tile_grid.hpp"

namespace biotomy::acquisition {
namespace {

using FrameDetail = std::vector<TileDetail>;

/// Beyond so many standard errors a difference is not noise.
constexpr double kStandsOut = 10.0;
constexpr double kCertain = 4.0;

/// Neighbouring differences have pixels in common: their products vary together.
constexpr double kDependence = 2.0;

/// A sweep whose frames differ by less of the sharpest's detail may be ranked by what drifts.
constexpr double kClearlyDifferent = 0.2;

/// The detail of the frames at one scale.
struct Curve {
  std::vector<double> values;
  std::vector<double> errors;

  explicit Curve(std::size_t frames) : values(frames), errors(frames) {}

  std::size_t best() const {
    return static_cast<std::size_t>(std::max_element(values.begin(), values.end()) -
                                    values.begin());
  }
  /// The difference of two frames in its standard errors.
  double told_apart(std::size_t a, std::size_t b) const {
    const double error = std::hypot(errors[a], errors[b]);
    const double difference = values[a] - values[b];
    return error > 0.0 ? difference / error : difference > 0.0 ? kStandsOut : 0.0;
  }
  std::size_t worst() const {
    return static_cast<std::size_t>(std::min_element(values.begin(), values.end()) -
                                    values.begin());
  }
  double stands_out() const { return told_apart(best(), worst()); }
  bool differs_clearly() const {
    return values[best()] > 0.0 &&
           values[best()] - values[worst()] >= kClearlyDifferent * values[best()];
  }
};

void check_alike(const cv::Mat& image, const cv::Size& size, int type, std::size_t number) {
  if (image.size() == size && image.type() == type) return;
  throw UnfitSweep("frame " + std::to_string(number) + " of the sweep (from 0) is " +
                   std::to_string(image.cols) + " × " + std::to_string(image.rows) + " of " +
                   (image.depth() == CV_16U ? "16" : "8") + " bits and the first " +
                   std::to_string(size.width) + " × " + std::to_string(size.height) + " of " +
                   (CV_MAT_DEPTH(type) == CV_16U ? "16" : "8") +
                   ": a sweep is of one field and one camera");
}

double median_or_zero(std::vector<double> values) {
  return values.empty() ? 0.0 : median(std::move(values));
}

/// How bright each frame is, relative to the sweep's mean. The median over the tiles: light that
/// moves from tile to tile as the focus changes is not the lamp's.
std::vector<double> relative_brightness(const std::vector<FrameDetail>& frames) {
  const std::size_t tiles = frames.front().size();
  std::vector<double> means(tiles);
  for (const FrameDetail& frame : frames) {
    for (std::size_t t = 0; t < tiles; ++t) {
      means[t] += frame[t].brightness / static_cast<double>(frames.size());
    }
  }
  std::vector<double> result;
  for (const FrameDetail& frame : frames) {
    std::vector<double> ratios;
    for (std::size_t t = 0; t < tiles; ++t) {
      if (frame[t].brightness > 0.0) ratios.push_back(frame[t].brightness / means[t]);
    }
    result.push_back(median_or_zero(std::move(ratios)));
  }
  return result;
}

/// The noise of a frame as its empty tiles tell: those whose two images share nothing that stands
/// out. 0 when none is empty.
double noise_of_empty_tiles(const FrameDetail& frame, std::size_t scale) {
  std::vector<double> noise;
  for (const TileDetail& tile : frame) {
    const SharedDetail& detail = tile.scales[scale];
    if (detail.count == 0.0) continue;
    const double error = std::sqrt(kDependence / detail.count) * detail.unshared();
    if (detail.shared < kCertain * error) noise.push_back(detail.unshared() / detail.count);
  }
  return median_or_zero(std::move(noise));
}

/// The noise in what the two images of a tile do not share, per pixel in each frame. A camera at
/// one setting has the same noise in all frames, or less where there is less light; what a frame
/// has beyond the quietest one is detail, unless its empty tiles have it too.
std::vector<double> noise_of_tile(const std::vector<FrameDetail>& frames,
                                  const std::vector<double>& brightness, std::size_t tile,
                                  std::size_t scale) {
  std::optional<double> least;
  double its_brightness = 1.0;
  for (std::size_t f = 0; f < frames.size(); ++f) {
    const SharedDetail& detail = frames[f][tile].scales[scale];
    if (detail.count == 0.0 || brightness[f] <= 0.0) continue;
    const double unshared = std::max(detail.unshared() / detail.count, 0.0);
    if (least && unshared / brightness[f] >= *least / its_brightness) continue;
    least = unshared;
    its_brightness = brightness[f];
  }
  std::vector<double> noise;
  for (std::size_t f = 0; f < frames.size(); ++f) {
    noise.push_back(std::max(least.value_or(0.0) * std::max(1.0, brightness[f] / its_brightness),
                             noise_of_empty_tiles(frames[f], scale)));
  }
  return noise;
}

/// The detail of one tile in every frame: what its two images share and, in frames that are
/// `nearly_sharp`, what is too fine for them to share and not noise.
Curve curve_of_tile(const std::vector<FrameDetail>& frames, const std::vector<double>& brightness,
                    std::size_t tile, std::size_t scale, const std::vector<bool>& nearly_sharp) {
  const std::vector<double> noise = noise_of_tile(frames, brightness, tile, scale);
  Curve curve(frames.size());
  for (std::size_t f = 0; f < frames.size(); ++f) {
    const SharedDetail& detail = frames[f][tile].scales[scale];
    const double power = brightness[f] * brightness[f];
    if (detail.count == 0.0 || power <= 0.0) continue;
    const double of_a_pixel = noise[f];
    const double shared = std::max(detail.shared / detail.count, 0.0);
    const double variance = kDependence * detail.count * of_a_pixel * (of_a_pixel + 2.0 * shared);
    const double finest = std::max(detail.unshared() - detail.count * of_a_pixel, 0.0);
    curve.values[f] = (detail.shared + (nearly_sharp[f] ? finest : 0.0)) / power;
    curve.errors[f] = std::sqrt(variance) / power;
  }
  return curve;
}

Curve sum_over_tiles(const std::vector<FrameDetail>& frames, const std::vector<double>& brightness,
                     std::size_t scale, const std::vector<bool>& nearly_sharp) {
  Curve sum(frames.size());
  for (std::size_t t = 0; t < frames.front().size(); ++t) {
    const Curve tile = curve_of_tile(frames, brightness, t, scale, nearly_sharp);
    for (std::size_t f = 0; f < frames.size(); ++f) {
      sum.values[f] += tile.values[f];
      sum.errors[f] = std::hypot(sum.errors[f], tile.errors[f]);
    }
  }
  return sum;
}

/// Frames with at least half of the detail that the best one's images share. Noise that grows along
/// the sweep looks like detail too fine to be shared: in other frames it has no say.
std::vector<bool> nearly_sharp(const std::vector<FrameDetail>& frames,
                               const std::vector<double>& brightness, std::size_t scale) {
  const Curve shared =
      sum_over_tiles(frames, brightness, scale, std::vector<bool>(frames.size(), false));
  const std::size_t best = shared.best();
  std::vector<bool> result;
  for (std::size_t f = 0; f < frames.size(); ++f) {
    result.push_back(shared.values[f] >= 0.5 * shared.values[best] ||
                     shared.told_apart(best, f) < kCertain);
  }
  return result;
}

/// The finest scale at which the frames differ beyond noise and clearly; if there is none, the one
/// at which they stand out most.
std::size_t choose_scale(const std::vector<Curve>& curves) {
  std::size_t best = 0;
  for (std::size_t scale = 0; scale < curves.size(); ++scale) {
    if (curves[scale].stands_out() >= kStandsOut && curves[scale].differs_clearly()) return scale;
    if (curves[scale].stands_out() > curves[best].stands_out()) best = scale;
  }
  return best;
}

/// For each frame, of how many tiles it is the sharpest; tiles that do not stand out are left out.
std::vector<int> tiles_won(const std::vector<FrameDetail>& frames,
                           const std::vector<double>& brightness, std::size_t scale) {
  const std::vector<bool> all(frames.size(), true);
  std::vector<int> won(frames.size());
  for (std::size_t t = 0; t < frames.front().size(); ++t) {
    const Curve curve = curve_of_tile(frames, brightness, t, scale, all);
    if (curve.stands_out() >= kStandsOut && curve.differs_clearly()) ++won[curve.best()];
  }
  return won;
}

/// The top of the parabola through the logarithms of the best value and its neighbours': near its
/// peak a focus curve is like a bell.
std::optional<double> peak_of(const Curve& curve) {
  const std::size_t best = curve.best();
  if (best == 0 || best + 1 == curve.values.size()) return std::nullopt;
  if (curve.values[best - 1] <= 0.0 || curve.values[best + 1] <= 0.0) {
    return static_cast<double>(best);
  }
  const double before = std::log(curve.values[best - 1]);
  const double here = std::log(curve.values[best]);
  const double after = std::log(curve.values[best + 1]);
  const double bend = before - 2.0 * here + after;
  const double offset = bend < 0.0 ? 0.5 * (before - after) / bend : 0.0;
  return static_cast<double>(best) + offset;
}

bool is_certain(const Curve& curve) {
  for (std::size_t f = 0; f < curve.values.size(); ++f) {
    if (f != curve.best() && curve.told_apart(curve.best(), f) < kCertain) return false;
  }
  return true;
}

}  // namespace

SweepRanking rank_sweep(std::size_t frames, const std::function<cv::Mat(std::size_t)>& read) {
  if (frames < 2) throw UnfitSweep("a sweep has two frames at least");
  SweepRanking ranking;
  ranking.frames.resize(frames);

  cv::Mat image = read(0);
  const cv::Size size = image.size();
  const int type = image.type();
  SweepMask mask(size);
  for (std::size_t f = 0; f < frames; ++f) {
    if (f > 0) image = read(f);
    check_alike(image, size, type, f);
    ranking.frames[f].clipped = mask.add(image);
  }
  const cv::Mat usable = mask.usable();
  if (usable.empty()) {
    throw UnfitSweep("the frames are clipped nearly everywhere: shorten the exposure");
  }
  ranking.usable =
      static_cast<double>(cv::countNonZero(usable)) / static_cast<double>(usable.total());

  const TileGrid grid = TileGrid::of(size);
  std::vector<FrameDetail> details;
  for (std::size_t f = 0; f < frames; ++f) {
    image = read(f);
    check_alike(image, size, type, f);
    details.push_back(measure_shared_detail(image, grid, usable));
  }

  const std::vector<double> brightness = relative_brightness(details);
  std::vector<Curve> curves;
  for (std::size_t scale = 0; scale < kDetailScales; ++scale) {
    curves.push_back(
        sum_over_tiles(details, brightness, scale, nearly_sharp(details, brightness, scale)));
  }
  const std::size_t scale = choose_scale(curves);
  const Curve& curve = curves[scale];
  const double best = curve.values[curve.best()];
  if (best <= 0.0) throw UnfitSweep("no frame of the sweep shows any detail");

  const std::vector<int> won = tiles_won(details, brightness, scale);
  for (std::size_t f = 0; f < frames; ++f) {
    SweepFrame& frame = ranking.frames[f];
    frame.focus = std::max(curve.values[f], 0.0) / best;
    frame.error = curve.errors[f] / best;
    frame.sharpest_tiles = won[f];
    frame.brightness = brightness[f];
  }
  ranking.sharpest = curve.best();
  ranking.certain = is_certain(curve);
  ranking.peak = peak_of(curve);
  ranking.detail_px = 4 << scale;
  return ranking;
}

}  // namespace biotomy::acquisition
