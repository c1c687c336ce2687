#include "reconstruct/picture/png_filter.hpp"

#include <cstdlib>
#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace biotomy::reconstruct {
namespace {

using Row = std::vector<std::uint8_t>;

/// PNG, third edition, section 9.2, word by word.
std::uint8_t reconstructed(PngFilter filter, std::uint8_t x, int a, int b, int c) {
  switch (filter) {
    case PngFilter::sub:
      return static_cast<std::uint8_t>(x + a);
    case PngFilter::up:
      return static_cast<std::uint8_t>(x + b);
    case PngFilter::average:
      return static_cast<std::uint8_t>(x + (a + b) / 2);
    case PngFilter::paeth: {
      const int p = a + b - c;
      const int pa = std::abs(p - a);
      const int pb = std::abs(p - b);
      const int pc = std::abs(p - c);
      return static_cast<std::uint8_t>(x + (pa <= pb && pa <= pc ? a : pb <= pc ? b : c));
    }
  }
  return 0;
}

Row noise_row(std::size_t size, unsigned seed) {
  std::mt19937 random(seed);
  Row row(size);
  for (std::uint8_t& byte : row) {
    byte = static_cast<std::uint8_t>(random());
  }
  return row;
}

TEST(PngFilter, IsUndoneByTheSpecification) {
  for (const PngFilter filter :
       {PngFilter::sub, PngFilter::up, PngFilter::average, PngFilter::paeth}) {
    for (const std::size_t step : {3U, 6U}) {
      for (const std::size_t pixels : {1U, 2U, 100U}) {
        const Row row = noise_row(step * pixels, 1);
        const Row above = noise_row(step * pixels, 2);
        Row filtered(row.size() + 1);
        filter_png_row(filter, row, above, step, filtered);
        EXPECT_EQ(filtered[0], static_cast<std::uint8_t>(filter));
        for (std::size_t i = 0; i < row.size(); ++i) {
          const int left = i < step ? 0 : row[i - step];
          const int corner = i < step ? 0 : above[i - step];
          ASSERT_EQ(reconstructed(filter, filtered[i + 1], left, above[i], corner), row[i]);
        }
      }
    }
  }
}

TEST(PngFilter, IsChosenByWhatTheRowResembles) {
  const Row above = noise_row(300, 3);
  EXPECT_EQ(best_png_filter(above, above, 3), PngFilter::up);

  Row repeated = noise_row(3, 4);
  while (repeated.size() < 300) {
    repeated.push_back(repeated[repeated.size() - 3]);
  }
  EXPECT_EQ(best_png_filter(repeated, above, 3), PngFilter::sub);

  Row between{9, 9, 9};
  for (std::size_t i = 3; i < 300; ++i) {
    between.push_back(static_cast<std::uint8_t>((between[i - 3] + above[i]) / 2));
  }
  EXPECT_EQ(best_png_filter(between, above, 3), PngFilter::average);
}

}  // namespace
}  // namespace biotomy::reconstruct
