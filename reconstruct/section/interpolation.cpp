#include "reconstruct/section/interpolation.hpp"

#include "reconstruct/errors.hpp"
#include "reconstruct/excerpt.hpp"

namespace biotomy::reconstruct {

Interpolation interpolation(const std::string& name) {
  if (name == "nearest") {
    return Interpolation::nearest;
  }
  if (name == "linear") {
    return Interpolation::linear;
  }
  if (name == "cubic") {
    return Interpolation::cubic;
  }
  throw InvalidRequest("no interpolation is called '" + excerpt(name) +
                       "': there are nearest, linear and cubic");
}

}  // namespace biotomy::reconstruct
