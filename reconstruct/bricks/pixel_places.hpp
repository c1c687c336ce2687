#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <type_traits>
#include <vector>

namespace biotomy::reconstruct {

/// Kernels work on whole vectors: so many places behind a row's last are read and written.
inline constexpr std::size_t kRoomPixels = 16;

/// A pixel whose pairs of texels are parted, as the right ones lie in the next brick along x.
struct PartedPixel {
  std::int32_t pixel = 0;
  std::array<const std::byte*, 2> upper{};  ///< the right texels of the row's `upper`
  std::array<const std::byte*, 2> lower{};
};

/// Where the pixels of a row lie, for the linear kernel: the pair of texels (at the whole part of x
/// and the next) in the row of the whole part of y and in the next row, both in the layer of the
/// whole part of z; the pairs in the next layer lie `down` bytes behind those or, where some of the
/// row's may be in another brick, at `lower`. And the place between the texels: 16 bits with levels
/// of 8 bits, float with 16.
template <typename Level>
struct PixelPlaces {
  using Part = std::conditional_t<sizeof(Level) == 1, std::uint16_t, float>;
  using Pairs = std::array<std::vector<const std::byte*>, 2>;  // in a row, and in the next

  Pairs upper;
  Pairs lower;  ///< filled and looked at only if `crosses`
  bool crosses = false;
  bool in_a_layer = false;  ///< then all pixels have the part of z of the first
  std::ptrdiff_t down = 0;
  std::vector<Part> x;
  std::vector<Part> y;
  std::vector<Part> z;

  /// In the row's order, the first `parted_count`: of their pairs only the left texel is one.
  std::vector<PartedPixel> parted;
  std::size_t parted_count = 0;

  void resize(std::size_t pixels) {
    for (Pairs* pairs : {&upper, &lower}) {
      for (auto& row : *pairs) {
        row.resize(pixels + kRoomPixels);
      }
    }
    for (auto* parts : {&x, &y, &z}) {
      parts->resize(pixels + kRoomPixels);
    }
    parted.resize(pixels);
  }

  /// The left texel of a pixel's pair in the next layer.
  const std::byte* below(std::size_t row, std::size_t pixel) const {
    return crosses ? lower[row][pixel] : upper[row][pixel] + down;
  }

  /// A part, 0 to below 1, as it is kept here.
  static Part part(float value) {
    return static_cast<Part>(sizeof(Level) == 1 ? value * 65536.0F : value);
  }
};

/// The lines of memory that a row's pairs lie in, to be asked for, so that they are near when it is
/// the row's turn: a section has no pattern that the processor could foresee. Asked for little by
/// little, while another row is mixed, they keep the memory busy all the time.
template <typename Level>
class PairLines {
 public:
  PairLines() = default;
  PairLines(const PixelPlaces<Level>& places, std::size_t count)
      : upper_{places.upper[0].data(), places.upper[1].data()},
        lower_{places.crosses ? places.lower[0].data() : upper_[0],
               places.crosses ? places.lower[1].data() : upper_[1]},
        down_(places.crosses ? 0 : places.down),
        count_(count) {}

  std::size_t count() const { return count_; }

  /// Asks for those of the pixels from `first` to before `end` that there are. They are to come
  /// into the second level of the cache: the first one is too small for two rows.
  [[gnu::always_inline]] void ask(std::size_t first, std::size_t end) const {
    end = end < count_ ? end : count_;
    for (std::size_t i = first; i < end; i += kPixelsOfALine) {
      for (std::size_t row = 0; row < 2; ++row) {
        __builtin_prefetch(upper_[row][i], 0, kSecondLevel);
        __builtin_prefetch(lower_[row][i] + down_, 0, kSecondLevel);
      }
    }
  }

 private:
  static constexpr int kSecondLevel = 2;
  static constexpr std::size_t kPixelsOfALine = 2;  // at least: a line holds 4 × 4 texels

  std::array<const std::byte* const*, 2> upper_{};
  std::array<const std::byte* const*, 2> lower_{};
  std::ptrdiff_t down_ = 0;
  std::size_t count_ = 0;
};

}  // namespace biotomy::reconstruct
