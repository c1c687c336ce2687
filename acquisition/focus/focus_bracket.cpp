#include "acquisition/focus/focus_bracket.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "acquisition/focus/detail.hpp"
#include "acquisition/focus/focus_curve.hpp"

namespace biotomy::acquisition {
namespace {

constexpr double kLeastInside = 0.5;     // steps
constexpr double kVertexCertain = 0.05;  // steps
constexpr double kMapCertain = 0.1;      // steps
constexpr double kMapNear = 1.0;         // steps
constexpr double kUnexplained = 0.1;     // of the variance
constexpr double kLikeNoise = 3.0;       // standard deviations
constexpr double kLeastDrop = 5.0;       // standard deviations

struct Curve {
  std::vector<MeasuredPoint> points;
  std::vector<std::size_t> tiles;
  std::size_t highest = 0;
  double drop = 0.0;      ///< from the highest to the lowest
  double noise = 0.0;     ///< of a point near the top
  double variance = 0.0;  ///< weighted
};

Curve curve_of(std::span<const BracketFrame> bracket) {
  std::vector<std::vector<Detail>> frames;
  for (const BracketFrame& frame : bracket) frames.push_back(detail_of_tiles(*frame.measures));
  Curve curve;
  curve.tiles = telling_tiles(frames);
  std::vector<Detail> along;
  along.reserve(frames.size());
  for (const std::vector<Detail>& tiles : frames) along.push_back(sum(tiles, curve.tiles));
  curve.points = focus_curve(along);
  if (curve.points.empty()) return curve;
  const auto [lowest, highest] = std::ranges::minmax_element(curve.points, {}, &MeasuredPoint::y);
  curve.highest = static_cast<std::size_t>(highest - curve.points.begin());
  curve.drop = highest->y - lowest->y;
  curve.noise = highest->error;
  double weights = 0.0;
  double mean = 0.0;
  for (const MeasuredPoint& point : curve.points) {
    weights += point.weight;
    mean += point.weight * point.y;
  }
  mean /= weights;
  for (const MeasuredPoint& point : curve.points) {
    curve.variance += point.weight * std::pow(point.y - mean, 2) / weights;
  }
  return curve;
}

bool explains(const ParabolaFit& fit, const Curve& curve) {
  const double unexplained = fit.residual * fit.residual;
  return unexplained <= kUnexplained * curve.variance || fit.residual <= kLikeNoise * curve.noise;
}

}  // namespace

BracketVerdict judge_bracket(std::span<const BracketFrame> bracket) {
  const Curve curve = curve_of(bracket);
  if (curve.points.empty()) return {};
  const bridge::Micrometres first = bracket.front().position;
  const std::size_t last = bracket.size() - 1;
  const bridge::Micrometres step =
      (1.0 / static_cast<double>(last)) * (bracket.back().position - first);

  BracketVerdict verdict;
  verdict.position = bracket[curve.highest].position;
  verdict.most = curve.points[curve.highest].y;
  verdict.tiles = curve.tiles;
  verdict.drop = curve.drop;
  verdict.uncertainty = curve.noise;
  if (curve.drop < kLeastDrop * curve.noise) return verdict;

  const std::optional<ParabolaFit> fit = fit_parabola(curve.points);
  const bool is_inside =
      fit && fit->vertex >= kLeastInside && fit->vertex <= static_cast<double>(last) - kLeastInside;
  if (is_inside && explains(*fit, curve)) {
    if (fit->vertex_error > kVertexCertain) return verdict;
    verdict.kind = BracketVerdict::Kind::peak;
    verdict.uncertainty = std::hypot(curve.noise, fit->residual);
    verdict.curvature = fit->curvature;
    verdict.position = first + fit->vertex * step;
    verdict.map = fit_focus_map(bracket);
    const auto is_within = [&](bridge::Micrometres length, double steps) {
      return std::abs(length.value) <= steps * step.value;
    };
    if (verdict.map && is_within(verdict.map->middle_error, kMapCertain) &&
        is_within(verdict.map->middle - verdict.position, kMapNear)) {
      verdict.position = verdict.map->middle;
    }
    return verdict;
  }
  const bool rises = fit && fit->vertex > static_cast<double>(last) - kLeastInside;
  const bool falls = fit && fit->vertex < kLeastInside;
  if (curve.highest == last || (rises && curve.highest + 1 == last)) {
    verdict.kind = BracketVerdict::Kind::higher;
    verdict.position = bracket.back().position;
  } else if (curve.highest == 0 || (falls && curve.highest == 1)) {
    verdict.kind = BracketVerdict::Kind::lower;
    verdict.position = first;
  } else {
    verdict.kind = BracketVerdict::Kind::rough;
  }
  return verdict;
}

std::optional<DetailLevel> detail_level(const FrameMeasures& measures,
                                        std::span<const std::size_t> tiles) {
  const Detail all = sum(detail_of_tiles(measures), tiles);
  if (all.energy <= all.error) return std::nullopt;
  return DetailLevel{std::log(all.energy), all.error / all.energy};
}

}  // namespace biotomy::acquisition
