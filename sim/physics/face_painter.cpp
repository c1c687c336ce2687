#include "sim/physics/face_painter.hpp"

#include <cmath>
#include <span>

#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

namespace biotomy::sim {

namespace {

// Colour is painted straight into the rows of a CV_32FC3 picture.
static_assert(sizeof(Colour) == 3 * sizeof(float));

const cv::Scalar kChipColour(206, 214, 206);  // frosted casting material
constexpr int kSubpixelBits = 4;

}  // namespace

FacePainter::FacePainter(const Phantom& phantom, const View& view, double first_face_um)
    : phantom_(phantom), view_(view), first_face_um_(first_face_um) {}

const cv::Mat& FacePainter::paint(const Block& block, const Displacement& displacement) {
  const bool ground = face_.empty() || painted_depth_um_ != block.strip_depth_um() ||
                      painted_displacement_ != displacement;
  if (ground) {
    paint_strips(block.strip_depth_um(), displacement);
  }
  if (ground || painted_passes_ != block.state().passes ||
      painted_blown_ms_ != block.state().blown_ms) {
    strew(block, displacement);
  }
  return picture_;
}

void FacePainter::paint_strips(const std::array<double, Block::kStrips>& depth_um,
                               const Displacement& displacement) {
  face_.create(view_.height, view_.width, CV_32FC3);
  const auto first_column = [&](std::size_t strip) {
    return static_cast<int>(strip * static_cast<std::size_t>(view_.width) / Block::kStrips);
  };
  cv::parallel_for_({0, view_.height}, [&](const cv::Range& rows) {
    for (int row = rows.start; row < rows.end; ++row) {
      auto* pixels = reinterpret_cast<Colour*>(face_.ptr<float>(row));
      for (std::size_t begin = 0; begin < Block::kStrips;) {
        std::size_t end = begin + 1;
        while (end < Block::kStrips && depth_um[end] == depth_um[begin]) {
          ++end;
        }
        const int from = first_column(begin);
        const std::span<Colour> part(pixels + from,
                                     static_cast<std::size_t>(first_column(end) - from));
        phantom_.paint_row(from * view_.pixel_um - displacement.x_um, view_.pixel_um,
                           row * view_.pixel_um - displacement.y_um,
                           depth_um[begin] - first_face_um_, part);
        begin = end;
      }
    }
  });
  painted_depth_um_ = depth_um;
  painted_displacement_ = displacement;
}

void FacePainter::strew(const Block& block, const Displacement& displacement) {
  face_.copyTo(picture_);
  constexpr double kSubpixels = 1 << kSubpixelBits;
  for (const Speck& speck : block.debris()) {
    const double x = static_cast<float>(view_.width) * speck.x + displacement.x_um / view_.pixel_um;
    const double y =
        static_cast<float>(view_.height) * speck.y + displacement.y_um / view_.pixel_um;
    const cv::Point centre(static_cast<int>(std::lround(kSubpixels * x)),
                           static_cast<int>(std::lround(kSubpixels * y)));
    const int radius = static_cast<int>(std::lround(speck.radius_um / view_.pixel_um * kSubpixels));
    cv::circle(picture_, centre, radius, kChipColour, cv::FILLED, cv::LINE_8, kSubpixelBits);
  }
  painted_passes_ = block.state().passes;
  painted_blown_ms_ = block.state().blown_ms;
}

}  // namespace biotomy::sim
