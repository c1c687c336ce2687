#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include <opencv2/core/mat.hpp>

namespace biotomy::acquisition {

/// A thumbnail in the scale in which the surface is compared: 255 times the square root of the part
/// of full scale, CV_8UC3. Photon noise is the same everywhere in it, and a small change of a dark
/// colour counts as much as a larger one of a bright one.
cv::Mat surface_scale(const cv::Mat& thumbnail);

/// Which colours a face has in which region: for each of at most 24 × 24 regions of the frame a set
/// of colours, 32 steps of the surface scale for each of R, G and B. Some 1.5 MB.
class SurfaceColours {
 public:
  /// `cells` is a thumbnail in surface scale.
  explicit SurfaceColours(const cv::Mat& cells);

  cv::Size frame() const { return frame_; }  ///< in cells

 private:
  friend class KnownColours;

  /// A bit for each step of B, a word for each pair of steps of R and G.
  static constexpr int kSteps = 32;
  static constexpr int kStepBits = 5;
  static constexpr std::size_t kWords = std::size_t{kSteps} * kSteps;
  static std::size_t word_of(const cv::Vec3b& cell);
  static std::uint32_t bit_of(const cv::Vec3b& cell);

  std::uint32_t* region(int x, int y) { return sets_.data() + kWords * index(x, y); }
  const std::uint32_t* region(int x, int y) const { return sets_.data() + kWords * index(x, y); }
  std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(columns_) +
           static_cast<std::size_t>(x);
  }

  cv::Size frame_;
  int side_ = 1;  ///< of a region, cells
  int columns_ = 0;
  int rows_ = 0;
  std::vector<std::uint32_t> sets_;
};

/// The colours that are known at each place: those that recent faces had in its region or one
/// beside it, and those one step from them. Tissue that a layer uncovers has nearly always a colour
/// that the faces before had nearby; what lies on the face has not.
class KnownColours {
 public:
  /// All of frames of one size, at least one.
  explicit KnownColours(const std::vector<std::shared_ptr<const SurfaceColours>>& faces);

  /// 255 where a cell's colour is not known, CV_8UC1. `cells` is a thumbnail in surface scale, of
  /// the same size.
  cv::Mat unknown_in(const cv::Mat& cells) const;

 private:
  SurfaceColours known_;
};

}  // namespace biotomy::acquisition
