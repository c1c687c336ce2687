#pragma once

#include <cstdint>
#include <vector>

namespace biotomy::bridge {

/// How the values of a picture follow the light.
enum class Transfer {
  srgb,    ///< by sRGB's transfer function, IEC 61966-2-1, section 5.2: what viewers expect
  linear,  ///< in proportion
};

/// That function for values of 8 or 16 bits. Light has 16 bits with either; 65535 is full scale. A
/// value of 8 bits is the same when it was made light and coded again; one of 16 bits if it was
/// coded from light of 16 bits, else it is off by at most seven, near black.
template <typename Value>
struct SrgbTables {
  std::vector<std::uint16_t> light;  ///< for each value
  std::vector<Value> value;          ///< for each light
};

/// For std::uint8_t and std::uint16_t; made once.
template <typename Value>
const SrgbTables<Value>& srgb_tables();

}  // namespace biotomy::bridge
