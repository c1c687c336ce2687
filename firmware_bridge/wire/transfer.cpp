#include "firmware_bridge/wire/transfer.hpp"

#include <cmath>
#include <limits>

namespace biotomy::bridge {
namespace {

constexpr int kFullLight = 65535;

double srgb_of(double light) {
  return light <= 0.0031308 ? 12.92 * light : 1.055 * std::pow(light, 1.0 / 2.4) - 0.055;
}

double light_of(double srgb) {
  return srgb <= 0.04045 ? srgb / 12.92 : std::pow((srgb + 0.055) / 1.055, 2.4);
}

template <typename Value>
SrgbTables<Value> make_tables() {
  constexpr int kFull = std::numeric_limits<Value>::max();
  SrgbTables<Value> tables;
  for (int value = 0; value <= kFull; ++value) {
    const double light = light_of(static_cast<double>(value) / kFull);
    tables.light.push_back(static_cast<std::uint16_t>(std::lround(light * kFullLight)));
  }
  for (int light = 0; light <= kFullLight; ++light) {
    const double value = srgb_of(static_cast<double>(light) / kFullLight);
    tables.value.push_back(static_cast<Value>(std::lround(value * kFull)));
  }
  return tables;
}

}  // namespace

template <typename Value>
const SrgbTables<Value>& srgb_tables() {
  static const SrgbTables<Value> tables = make_tables<Value>();
  return tables;
}

template const SrgbTables<std::uint8_t>& srgb_tables<std::uint8_t>();
template const SrgbTables<std::uint16_t>& srgb_tables<std::uint16_t>();

}  // namespace biotomy::bridge
