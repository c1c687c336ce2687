#pragma once

#include <cstdint>
#include <span>
#include <stdexcept>
#include <string>

#include "firmware_bridge/wire/register_map.hpp"

namespace biotomy::bridge {

/// A value that its register cannot hold. Nothing is ever wrapped or clamped: a target position
/// that comes out as another number would break the wheel.
class RegisterRangeError : public std::out_of_range {
 public:
  explicit RegisterRangeError(const std::string& message) : std::out_of_range(message) {}
};

/// Writes `value` (in the entry's unit) into the first width() elements of `registers`, in the
/// entry's word order, rounded to the nearest multiple of the scale. Throws RegisterRangeError if
/// it is not finite or does not fit; then `registers` is untouched.
void encode(const RegisterEntry& entry, double value, std::span<std::uint16_t> registers);

/// The value, in the entry's unit, of the first width() elements of `registers`. An f32 may be NaN
/// or infinite: that is for the caller to judge.
double decode(const RegisterEntry& entry, std::span<const std::uint16_t> registers);

}  // namespace biotomy::bridge
