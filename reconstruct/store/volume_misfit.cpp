#include "reconstruct/store/volume_misfit.hpp"

#include <array>
#include <charconv>

namespace biotomy::reconstruct {
namespace {

/// With all its digits: what differs in the last one must not look alike.
template <typename Number>
std::string number_text(Number number) {
  std::array<char, 32> text{};
  return {text.data(), std::to_chars(text.data(), text.data() + text.size(), number).ptr};
}

class Differences {
 public:
  template <typename Number>
  void compare(const char* key, Number found, Number described) {
    if (found != described) {
      text_ += (text_.empty() ? "" : "; ") + std::string(key) + " is " + number_text(found) +
               ", in sample.toml " + number_text(described);
    }
  }
  const std::string& text() const { return text_; }

 private:
  std::string text_;
};

}  // namespace

std::optional<std::string> misfit(const Cuboid& cuboid, int bits, const SampleFolder& sample) {
  const SampleDescription& description = sample.description();
  const auto& [size, spacing] = description.cuboid;
  Differences differences;
  differences.compare("grid.width", cuboid.size.x, size.x);
  differences.compare("grid.height", cuboid.size.y, size.y);
  differences.compare("grid.layers", cuboid.size.z, size.z);
  differences.compare("spacing_um.x", cuboid.spacing.x, spacing.x);
  differences.compare("spacing_um.y", cuboid.spacing.y, spacing.y);
  differences.compare("spacing_um.z", cuboid.spacing.z, spacing.z);
  differences.compare("bits", bits, description.bits);
  if (differences.text().empty()) {
    return std::nullopt;
  }
  return "does not fit the sample's description: " + differences.text() +
         "; if sample.toml is right, biotomy rebuild " + sample.path().string() +
         " makes the volume anew";
}

}  // namespace biotomy::reconstruct
