#include "tests/bench/named_planes.hpp"

#include <fstream>
#include <sstream>

#include "reconstruct/errors.hpp"

namespace biotomy::bench {

using reconstruct::InvalidRequest;
using reconstruct::SampleError;

std::vector<NamedPlane> read_planes(const std::filesystem::path& file, const std::string& only) {
  std::ifstream in(file);
  if (!in) {
    throw SampleError(file.string() + ": cannot be opened");
  }
  std::vector<NamedPlane> planes;
  std::string line;
  for (int number = 1; std::getline(in, line); ++number) {
    std::istringstream words(line);
    NamedPlane plane;
    if (!(words >> plane.name) || plane.name.front() == '#') {
      continue;
    }
    for (reconstruct::Vector3& point : plane.points) {
      words >> point.x >> point.y >> point.z;
    }
    std::string rest;
    if (!words || words >> rest) {
      throw SampleError(file.string() + ": line " + std::to_string(number) +
                        ": must be a name and nine numbers");
    }
    if (only.empty() || plane.name == only) {
      planes.push_back(plane);
    }
  }
  if (planes.empty()) {
    throw InvalidRequest(file.string() + ": has no plane" +
                         (only.empty() ? std::string{} : " named " + only));
  }
  return planes;
}

}  // namespace biotomy::bench
