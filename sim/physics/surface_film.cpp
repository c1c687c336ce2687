#include "sim/physics/surface_film.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "sim/phantom/gradient_noise.hpp"

namespace biotomy::sim {

namespace {

constexpr std::uint64_t kFrostStream = 0x66726f73;
constexpr std::uint64_t kGlareStream = 0x676c6172;

const cv::Vec3f kRime(228, 236, 240);

/// Patches are worked out on a coarser grid: they have no fine detail.
constexpr int kCoarse = 8;

constexpr double kPatchesAcross = 5.0;  // cells of the noise on the frame's longer side
constexpr float kPatchEdge = 0.15F;     // of the noise's range, from bare to full veil

/// How much of the veil is where, 0 to 1: 0.5 or more over `share` of the frame.
cv::Mat patches(cv::Size frame, double share, std::uint64_t seed) {
  cv::Mat noise(std::max(1, frame.height / kCoarse), std::max(1, frame.width / kCoarse), CV_32F);
  const GradientNoise field(seed, std::max(noise.cols, noise.rows) / kPatchesAcross);
  for (int y = 0; y < noise.rows; ++y) {
    GradientNoise::Line line = field.line(y + 0.37, 0.41);
    for (int x = 0; x < noise.cols; ++x) noise.at<float>(y, x) = line.at(x + 0.29);
  }
  std::vector<float> sorted(noise.begin<float>(), noise.end<float>());
  const auto rank = static_cast<std::ptrdiff_t>(std::clamp(1.0 - share, 0.0, 1.0) *
                                                static_cast<double>(sorted.size() - 1));
  std::ranges::nth_element(sorted, sorted.begin() + rank);
  const float middle = sorted[static_cast<std::size_t>(rank)];
  noise = (noise - middle) / kPatchEdge + 0.5;
  cv::Mat veil = cv::min(cv::max(noise, 0.0), 1.0);
  cv::resize(veil, veil, frame, 0.0, 0.0, cv::INTER_LINEAR);
  return veil;
}

void lay_frost(cv::Mat& picture, const Frost& frost, std::uint64_t seed) {
  const cv::Mat veil = patches(picture.size(), frost.share, seed);
  const auto opacity = static_cast<float>(frost.opacity);
  cv::parallel_for_({0, picture.rows}, [&](const cv::Range& rows) {
    for (int y = rows.start; y < rows.end; ++y) {
      auto* pixels = picture.ptr<cv::Vec3f>(y);
      const auto* cover = veil.ptr<float>(y);
      for (int x = 0; x < picture.cols; ++x) {
        const float share = opacity * cover[x];
        pixels[x] = pixels[x] * (1.0F - share) + kRime * share;
      }
    }
  });
}

void add_glare(cv::Mat& picture, const Glare& glare, std::uint64_t seed) {
  constexpr double kLargest = 0.02;  // radius of a spot, of the frame's longer side
  constexpr int kMostSpots = 1000;
  constexpr double kFlank = 0.3;      // of the radius: from full glare to none
  constexpr float kBrightness = 500;  // levels: beyond what a sensor shows
  const double side = std::max(picture.cols, picture.rows);
  double left = glare.share * static_cast<double>(picture.total());
  for (int spot = 0; spot < kMostSpots && left >= 1.0; ++spot) {
    const auto drawn = [&](std::uint64_t which) {
      return mixed_fraction(seed, 3 * static_cast<std::uint64_t>(spot) + which);
    };
    const double radius = std::min(std::max(1.5, kLargest * side * (0.3 + 0.7 * drawn(0))),
                                   std::sqrt(left / std::numbers::pi));
    left -= std::numbers::pi * radius * radius;
    const double centre_x = static_cast<double>(drawn(1)) * picture.cols;
    const double centre_y = static_cast<double>(drawn(2)) * picture.rows;
    const double reach = radius * (1.0 + 0.5 * kFlank);
    const cv::Rect around =
        cv::Rect(static_cast<int>(centre_x - reach), static_cast<int>(centre_y - reach),
                 static_cast<int>(2 * reach) + 2, static_cast<int>(2 * reach) + 2) &
        cv::Rect(0, 0, picture.cols, picture.rows);
    for (int y = around.y; y < around.br().y; ++y) {
      for (int x = around.x; x < around.br().x; ++x) {
        const double away = std::hypot(x - centre_x, y - centre_y) / radius;
        const double share = std::clamp((1.0 - away) / kFlank + 0.5, 0.0, 1.0);
        picture.at<cv::Vec3f>(y, x) += cv::Vec3f::all(kBrightness * static_cast<float>(share));
      }
    }
  }
}

}  // namespace

void lay_film(cv::Mat& picture, const SurfaceFilm& film, std::uint64_t seed) {
  if (film.frost.share > 0.0) lay_frost(picture, film.frost, seed ^ kFrostStream);
  if (film.glare.share > 0.0) add_glare(picture, film.glare, seed ^ kGlareStream);
}

}  // namespace biotomy::sim
