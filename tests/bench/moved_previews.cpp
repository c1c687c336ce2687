// How long previews take within one program, as a page that lets one drag a plane wants them: the
// first one, with nothing in memory, and the median of others, for which the plane is moved along
// its normal by a pixel each time. Prints one line of JSON.
//
//   moved_previews SAMPLE --planes FILE --only NAME --pixel 8.0 [--steps 10]

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <iostream>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "reconstruct/bricks/volume_bricks.hpp"
#include "reconstruct/geometry/plane.hpp"
#include "reconstruct/geometry/section_basis.hpp"
#include "reconstruct/sample/sample_folder.hpp"
#include "reconstruct/section/section.hpp"
#include "reconstruct/store/volume.hpp"
#include "tests/bench/exit_code.hpp"
#include "tests/bench/named_planes.hpp"

namespace {

using namespace biotomy::bench;
using namespace biotomy::reconstruct;

constexpr std::size_t kCacheBytes = 512'000'000;  // what the commands take unless told otherwise

struct Options {
  std::string sample;
  std::string planes;
  std::string only;
  double pixel = 1.0;
  int steps = 10;
};

void run(const Options& options) {
  const Volume volume = Volume::of_sample(SampleFolder::open(options.sample));
  const Vector3& spacing = volume.cuboid().spacing;
  const NamedPlane named = read_planes(options.planes, options.only).front();
  std::array<Vector3, 3> points;
  std::transform(named.points.begin(), named.points.end(), points.begin(), [&](const Vector3& p) {
    return Vector3{p.x * spacing.x, p.y * spacing.y, p.z * spacing.z};
  });
  const double pixel = options.pixel * std::min({spacing.x, spacing.y, spacing.z});
  const Plane start = Plane::through_points(points[0], points[1], points[2]);
  SectionStyle style;
  style.pixel = pixel;

  // Towards the middle of the block, so that the plane stays in it.
  const double to_middle = start.signed_distance(0.5 * volume.cuboid().extent());
  const Vector3 move = std::copysign(pixel, to_middle) * start.normal();

  VolumeBricks bricks(volume, kCacheBytes);
  std::vector<double> seconds;
  for (int step = 0; step <= options.steps; ++step) {
    const Plane plane = Plane::from_normal(start.normal(), points[0] + step * move);
    const auto begin = std::chrono::steady_clock::now();
    cut_section(bricks, {plane, section_basis(BasisKind::layer, plane), style});
    seconds.push_back(
        std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count());
  }
  const double first = seconds.front();
  std::sort(seconds.begin() + 1, seconds.end());
  std::cout << nlohmann::ordered_json{{"first_s", first},
                                      {"moved_s", seconds[1 + seconds.size() / 2]},
                                      {"moved_most_s", seconds.back()}}
                   .dump()
            << '\n';
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"Times previews of a plane that is moved"};
  Options options;
  app.add_option("SAMPLE", options.sample, "The sample's folder")->required();
  app.add_option("--planes", options.planes, "File of planes, in voxels")->required();
  app.add_option("--only", options.only, "The plane of this name")->required();
  app.add_option("--pixel", options.pixel, "In voxels")->required()->check(CLI::PositiveNumber);
  app.add_option("--steps", options.steps, "How often the plane is moved")
      ->check(CLI::Range(2, 1000))
      ->capture_default_str();
  CLI11_PARSE(app, argc, argv);
  return exit_code_of("moved_previews", [&] { run(options); });
}
