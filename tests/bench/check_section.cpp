// Compares a section's picture with the formula of the sample that scale_store made: at random
// pixels, the colours interpolated in double precision between the voxels around. Fails when one is
// off by more than a level, or when too few pixels could be compared.
//
//   check_section PICTURE --sample SAMPLE --planes FILE --only NAME [--noisy 0.05] [--pixels
//   200000]

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <iostream>
#include <random>
#include <sstream>
#include <string>

#include <CLI/CLI.hpp>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>

#include "reconstruct/errors.hpp"
#include "reconstruct/sample/sample_folder.hpp"
#include "tests/bench/exit_code.hpp"
#include "tests/bench/made_up_tissue.hpp"
#include "tests/bench/named_planes.hpp"
#include "tests/bench/section_pixels.hpp"

namespace {

using namespace biotomy::bench;
using namespace biotomy::reconstruct;

struct Options {
  std::string picture;
  std::string sample;
  std::string planes;
  std::string only;
  double noisy = 0.05;
  int pixels = 200'000;
};

constexpr double kBorder = 1e-3;     // of a voxel: nearer to the border, rounding decides
constexpr double kTolerance = 1.01;  // of a level: rounding to the nearest, and one beside it
constexpr double kEnough = 0.3;      // of the asked pixels: a hexagon fills half of its rectangle

/// The voxels below and above a coordinate, and the share of the one above.
struct Neighbours {
  std::int64_t below;
  std::int64_t above;
  double share;

  Neighbours(double coordinate, std::int64_t size)
      : below(std::clamp<std::int64_t>(static_cast<std::int64_t>(std::floor(coordinate)), 0,
                                       size - 1)),
        above(std::min(below + 1, size - 1)),
        share(std::clamp(coordinate - static_cast<double>(below), 0.0, 1.0)) {}

  std::int64_t at(int end) const { return end == 0 ? below : above; }
  double weight(int end) const { return end == 0 ? 1.0 - share : share; }
};

std::array<double, 3> interpolated(const MadeUpTissue& tissue, const Vector3& voxel,
                                   const GridSize& size) {
  const Neighbours x(voxel.x, size.x);
  const Neighbours y(voxel.y, size.y);
  const Neighbours z(voxel.z, size.z);
  std::array<double, 3> colour{};
  for (int corner = 0; corner < 8; ++corner) {
    const int right = corner & 1;
    const int lower = (corner >> 1) & 1;
    const int deeper = corner >> 2;
    const auto at = tissue.voxel(x.at(right), y.at(lower), z.at(deeper));
    for (std::size_t c = 0; c < colour.size(); ++c) {
      colour[c] += x.weight(right) * y.weight(lower) * z.weight(deeper) * at[c];
    }
  }
  return colour;
}

void run(const Options& options) {
  const Cuboid cuboid = SampleFolder::open(options.sample).description().cuboid;
  const NamedPlane plane = read_planes(options.planes, options.only).front();
  const double pixel = std::min({cuboid.spacing.x, cuboid.spacing.y, cuboid.spacing.z});
  const SectionPixels pixels = section_pixels(plane, cuboid, pixel);
  const MadeUpTissue tissue(options.noisy);
  const cv::Mat picture = cv::imread(options.picture, cv::IMREAD_COLOR);  // B, G, R
  if (picture.cols != pixels.columns || picture.rows != pixels.rows) {
    std::ostringstream message;
    message << options.picture << ": is " << picture.cols << " x " << picture.rows
            << " pixels, the section has " << pixels.columns << " x " << pixels.rows;
    throw SampleError(message.str());
  }

  std::mt19937_64 random(42);
  std::uniform_int_distribution<std::int64_t> columns(0, pixels.columns - 1);
  std::uniform_int_distribution<std::int64_t> rows(0, pixels.rows - 1);
  int compared = 0;
  double worst = 0.0;
  for (int i = 0; i < options.pixels; ++i) {
    const std::int64_t column = columns(random);
    const std::int64_t row = rows(random);
    const Vector3 voxel = pixels.voxel(column, row);
    const auto& seen = picture.at<cv::Vec3b>(static_cast<int>(row), static_cast<int>(column));
    std::array<double, 3> expected{};  // background is black
    if (pixels.inside(voxel, -kBorder)) {
      expected = interpolated(tissue, voxel, cuboid.size);
      ++compared;
    } else if (pixels.inside(voxel, kBorder)) {
      continue;
    }
    for (int c = 0; c < 3; ++c) {
      const double off = std::abs(seen[2 - c] - expected[static_cast<std::size_t>(c)]);
      worst = std::max(worst, off);
      if (off > kTolerance) {
        std::ostringstream message;
        message << options.picture << ": pixel " << column << "," << row << " has colour " << c
                << " " << int{seen[2 - c]} << ", the formula says "
                << expected[static_cast<std::size_t>(c)];
        throw SampleError(message.str());
      }
    }
  }
  if (compared < kEnough * options.pixels) {
    throw SampleError(options.picture + ": only " + std::to_string(compared) + " of " +
                      std::to_string(options.pixels) + " pixels are in the sample");
  }
  std::cout << compared << " pixels compared, the worst is off by " << worst << " levels\n";
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"Compares a section's picture with the formula of a made-up sample."};
  Options options;
  app.add_option("PICTURE", options.picture, "As biotomy section made it")->required();
  app.add_option("--sample", options.sample, "The sample's folder")->required();
  app.add_option("--planes", options.planes, "File of planes, in voxels")->required();
  app.add_option("--only", options.only, "The plane of this name")->required();
  app.add_option("--noisy", options.noisy, "As the sample was made")->capture_default_str();
  app.add_option("--pixels", options.pixels, "To be compared")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  CLI11_PARSE(app, argc, argv);
  return exit_code_of("check_section", [&] { run(options); });
}
