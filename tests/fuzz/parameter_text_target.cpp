#include <string>

#include "reconstruct/section/parameter_text.hpp"
#include "tests/fuzz/fuzz_targets.hpp"
#include "tests/fuzz/refusal.hpp"

namespace biotomy::tests {

bool fuzz_parameter_text(FuzzInput input) {
  const std::string text(reinterpret_cast<const char*>(input.data()), input.size());
  bool taken = accepts("--pixel", [&] { reconstruct::parse_number("--pixel", text); });
  taken |= accepts("--background", [&] { reconstruct::parse_colour("--background", text); });
  taken |= accepts("--unit", [&] { reconstruct::parse_unit("--unit", text); });
  const auto plane = [&](const reconstruct::PlaneText& words) {
    reconstruct::parse_plane("--", words, reconstruct::LengthUnit::voxels, {10, 10, 20});
  };
  taken |= accepts("", [&] { plane({text, {}, {}}); });
  const std::size_t half = text.find(' ');
  if (half != std::string::npos) {
    taken |= accepts("", [&] { plane({{}, text.substr(0, half), text.substr(half + 1)}); });
  }
  return taken;
}

}  // namespace biotomy::tests
