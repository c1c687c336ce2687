#include "acquisition/quality/light_change.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "acquisition/quality/median.hpp"

namespace biotomy::acquisition {
namespace {

constexpr std::size_t kTerms = SmoothSurface::kTerms;
constexpr std::size_t kColours = 3;
constexpr int kMostCells = 64;
constexpr int kRounds = 12;
constexpr double kTukey = 4.685;  ///< 95 % as efficient as least squares where all errs normally
constexpr double kNormal = 1.4826;
constexpr double kLeastScale = 0.004;  ///< of the ratio; nothing is known better
constexpr double kCastingWeight = 4.0;
constexpr std::size_t kEnoughCasting = 48;  ///< cells, for the scale to be theirs
constexpr double kAlike = 2.0;  ///< neighbours err alike: by so much the errors are greater
constexpr float kDark = 0.008F;
constexpr float kBright = 0.985F;  ///< nearly clipped: follows no light

struct Place {
  int x = 0;
  int y = 0;
  bool casting = false;
  std::array<double, kTerms> terms{};
  std::array<double, kColours> ratio{};  ///< its logarithm
  double residual = 0.0;                 ///< the greatest of the colours'
  double weight = 1.0;
};

double along(int index, int count) {
  return (2.0 * index + 1.0) / count - 1.0;
}

bool usable(const cv::Vec3f& cell) {
  return std::min({cell[0], cell[1], cell[2]}) > kDark &&
         std::max({cell[0], cell[1], cell[2]}) < kBright;
}

std::vector<Place> places_of(const cv::Mat& now, const cv::Mat& before, const cv::Mat& casting) {
  std::vector<Place> places;
  places.reserve(now.total());
  for (int y = 0; y < now.rows; ++y) {
    const auto* a = now.ptr<cv::Vec3f>(y);
    const auto* b = before.ptr<cv::Vec3f>(y);
    for (int x = 0; x < now.cols; ++x) {
      if (!usable(a[x]) || !usable(b[x])) continue;
      Place place{.x = x, .y = y, .casting = casting.at<std::uint8_t>(y, x) != 0};
      place.terms = SmoothSurface::terms(along(x, now.cols), along(y, now.rows));
      for (std::size_t c = 0; c < kColours; ++c) {
        const int i = static_cast<int>(c);
        place.ratio[c] = std::log(static_cast<double>(a[x][i]) / static_cast<double>(b[x][i]));
      }
      places.push_back(place);
    }
  }
  return places;
}

/// The median of a number that each place has: of the casting material's where there are enough,
/// else of all.
template <typename Number>
double median_of(const std::vector<Place>& places, const Number& number) {
  const auto casting = static_cast<std::size_t>(std::ranges::count_if(places, &Place::casting));
  std::vector<double> values;
  values.reserve(places.size());
  for (const Place& place : places) {
    if (casting < kEnoughCasting || place.casting) values.push_back(number(place));
  }
  return median(std::move(values));
}

double median_residual(const std::vector<Place>& places) {
  return median_of(places, [](const Place& place) { return place.residual; });
}

void find_residuals(const LightChange& change, std::vector<Place>& places) {
  for (Place& place : places) {
    place.residual = 0.0;
    for (std::size_t c = 0; c < kColours; ++c) {
      double fitted = 0.0;
      for (std::size_t i = 0; i < kTerms; ++i) {
        fitted += change.colours[c].coefficients[i] * place.terms[i];
      }
      place.residual = std::max(place.residual, std::fabs(place.ratio[c] - fitted));
    }
  }
}

void weigh(double scale, std::vector<Place>& places) {
  for (Place& place : places) {
    const double t = place.residual / (kTukey * scale);
    const double kept = t < 1.0 ? (1.0 - t * t) * (1.0 - t * t) : 0.0;
    place.weight = kept * (place.casting ? kCastingWeight : 1.0);
  }
}

/// The medians alone: where the search begins.
LightChange level_of(const std::vector<Place>& places) {
  LightChange change;
  for (std::size_t c = 0; c < kColours; ++c) {
    change.colours[c].coefficients[0] =
        median_of(places, [c](const Place& place) { return place.ratio[c]; });
  }
  return change;
}

/// The normal equations: sums over all places by their weights.
struct Equations {
  cv::Matx<double, kTerms, kTerms> products = cv::Matx<double, kTerms, kTerms>::zeros();
  cv::Matx<double, kTerms, kColours> with_ratio = cv::Matx<double, kTerms, kColours>::zeros();

  explicit Equations(const std::vector<Place>& places) {
    double all = 0.0;
    for (const Place& place : places) {
      all += place.weight;
      for (std::size_t i = 0; i < kTerms; ++i) {
        const double weighted = place.weight * place.terms[i];
        const int row = static_cast<int>(i);
        for (std::size_t j = 0; j < kTerms; ++j) {
          products(row, static_cast<int>(j)) += weighted * place.terms[j];
        }
        for (std::size_t c = 0; c < kColours; ++c) {
          with_ratio(row, static_cast<int>(c)) += weighted * place.ratio[c];
        }
      }
    }
    // Where the places say nothing of a term it is nothing.
    constexpr double kRidge = 1e-4;
    for (int i = 0; i < static_cast<int>(kTerms); ++i) products(i, i) += kRidge * all + 1e-9;
  }
};

LightChange solve(const Equations& equations) {
  const cv::Matx<double, kTerms, kColours> solution =
      equations.products.solve(equations.with_ratio, cv::DECOMP_CHOLESKY);
  LightChange change;
  for (std::size_t c = 0; c < kColours; ++c) {
    for (std::size_t i = 0; i < kTerms; ++i) {
      change.colours[c].coefficients[i] = solution(static_cast<int>(i), static_cast<int>(c));
    }
  }
  return change;
}

/// Standard deviation of the surface's difference between two places, or of its mean.
double error_of(const cv::Matx<double, kTerms, kTerms>& covariance,
                const std::array<double, kTerms>& terms) {
  const cv::Matx<double, kTerms, 1> t(terms.data());
  return std::sqrt(std::max(0.0, (t.t() * covariance * t)(0)));
}

}  // namespace

std::array<double, SmoothSurface::kTerms> SmoothSurface::terms(double u, double v) {
  constexpr double kThird = 1.0 / 3.0;
  return {1.0, u, v, u * u - kThird, u * v, v * v - kThird};
}

double SmoothSurface::at(double u, double v) const {
  const std::array<double, kTerms> t = terms(u, v);
  double value = 0.0;
  for (std::size_t i = 0; i < kTerms; ++i) value += coefficients[i] * t[i];
  return value;
}

double SmoothSurface::range() const {
  constexpr int kPlaces = 8;
  double least = at(0.0, 0.0);
  double most = least;
  for (int j = 0; j <= kPlaces; ++j) {
    for (int i = 0; i <= kPlaces; ++i) {
      const double value = at(2.0 * i / kPlaces - 1.0, 2.0 * j / kPlaces - 1.0);
      least = std::min(least, value);
      most = std::max(most, value);
    }
  }
  return most - least;
}

SmoothSurface LightChange::brightness() const {
  SmoothSurface surface;
  for (std::size_t i = 0; i < kTerms; ++i) {
    surface.coefficients[i] = 0.25 * colours[0].coefficients[i] + 0.5 * colours[1].coefficients[i] +
                              0.25 * colours[2].coefficients[i];
  }
  return surface;
}

double LightChange::cast() const {
  const auto [least, most] = std::minmax({colours[0].mean(), colours[1].mean(), colours[2].mean()});
  return most - least;
}

LightChange operator+(const LightChange& a, const LightChange& b) {
  LightChange sum = a;
  for (std::size_t c = 0; c < kColours; ++c) {
    for (std::size_t i = 0; i < kTerms; ++i) {
      sum.colours[c].coefficients[i] += b.colours[c].coefficients[i];
    }
  }
  return sum;
}

LightChange operator-(const LightChange& a, const LightChange& b) {
  LightChange difference = a;
  for (std::size_t c = 0; c < kColours; ++c) {
    for (std::size_t i = 0; i < kTerms; ++i) {
      difference.colours[c].coefficients[i] -= b.colours[c].coefficients[i];
    }
  }
  return difference;
}

MeasuredLight measure_light(const cv::Mat& now, const cv::Mat& before, const cv::Mat& casting) {
  MeasuredLight light;
  light.steady = cv::Mat::zeros(now.size(), CV_8UC1);
  std::vector<Place> places = places_of(now, before, casting);
  if (places.size() < 2 * kTerms) {
    light.level_error = light.range_error = 1.0;
    return light;
  }
  light.change = level_of(places);
  double scale = 0.0;
  for (int round = 0; round < kRounds; ++round) {
    find_residuals(light.change, places);
    scale = std::max(kLeastScale, kNormal * median_residual(places));
    weigh(scale, places);
    light.change = solve(Equations(places));
  }

  find_residuals(light.change, places);
  weigh(scale, places);
  double squares = 0.0;
  double weights = 0.0;
  for (const Place& place : places) {
    squares += place.weight * place.residual * place.residual;
    weights += place.weight;
    if (place.weight > 0.0) light.steady.at<std::uint8_t>(place.y, place.x) = 255;
  }
  const double variance = weights > 0.0 ? kAlike * kAlike * squares / weights : 1.0;
  const auto covariance = variance * Equations(places).products.inv(cv::DECOMP_CHOLESKY);
  light.level_error = error_of(covariance, {1.0});
  // From corner to corner, and from the middle to a corner.
  light.range_error = std::max(error_of(covariance, {0.0, 2.0, 2.0, 0.0, 0.0, 0.0}),
                               error_of(covariance, {0.0, 1.0, 1.0, 1.0, 1.0, 1.0}));
  return light;
}

cv::Mat light_grid(const cv::Mat& thumbnail) {
  if (thumbnail.empty()) return {};
  const int side = std::max(thumbnail.cols, thumbnail.rows);
  const int scale = (side + kMostCells - 1) / kMostCells;
  const cv::Size size(thumbnail.cols / scale, thumbnail.rows / scale);
  if (scale == 1 || size.empty()) return thumbnail;
  cv::Mat grid;
  cv::resize(thumbnail({0, 0, size.width * scale, size.height * scale}), grid, size, 0.0, 0.0,
             cv::INTER_AREA);
  return grid;
}

}  // namespace biotomy::acquisition
