#include "firmware_bridge/wire/register_codec.hpp"

#include <bit>
#include <cmath>
#include <limits>
#include <sstream>

namespace biotomy::bridge {

namespace {

struct RawRange {
  double minimum;
  double maximum;
};

template <class Integer>
constexpr RawRange range_of() {
  return {static_cast<double>(std::numeric_limits<Integer>::min()),
          static_cast<double>(std::numeric_limits<Integer>::max())};
}

RawRange raw_range(RegisterType type) {
  switch (type) {
    case RegisterType::u16:
      return range_of<std::uint16_t>();
    case RegisterType::i16:
      return range_of<std::int16_t>();
    case RegisterType::u32:
      return range_of<std::uint32_t>();
    case RegisterType::i32:
      return range_of<std::int32_t>();
    case RegisterType::f32:
      return {-static_cast<double>(std::numeric_limits<float>::max()),
              static_cast<double>(std::numeric_limits<float>::max())};
  }
  return {0.0, 0.0};
}

/// value / scale and back, through the whole number 1/scale where there is one: 0.1 is not exact
/// in binary, 10 is, and so 123 tenths come out as 12.3 and not as 12.300000000000001.
double to_raw(double value, double scale) {
  const double inverse = std::round(1.0 / scale);
  return inverse * scale == 1.0 ? value * inverse : value / scale;
}
double from_raw(double raw, double scale) {
  const double inverse = std::round(1.0 / scale);
  return inverse * scale == 1.0 ? raw / inverse : raw * scale;
}

void check_room(const RegisterEntry& entry, std::size_t registers) {
  if (registers < static_cast<std::size_t>(entry.width())) {
    throw std::invalid_argument("register " + entry.name + " needs " +
                                std::to_string(entry.width()) + " registers, given " +
                                std::to_string(registers));
  }
}

[[noreturn]] void refuse(const RegisterEntry& entry, double value) {
  const RawRange range = raw_range(entry.type);
  std::ostringstream text;
  text.precision(12);
  text << "register " << entry.name << ": " << value << " " << entry.unit
       << (entry.unit.empty() ? "" : " ") << "does not fit; it holds "
       << from_raw(range.minimum, entry.scale) << " to " << from_raw(range.maximum, entry.scale);
  throw RegisterRangeError(text.str());
}

}  // namespace

void encode(const RegisterEntry& entry, double value, std::span<std::uint16_t> registers) {
  check_room(entry, registers.size());
  double raw = to_raw(value, entry.scale);
  if (entry.type != RegisterType::f32) raw = std::round(raw);
  const RawRange range = raw_range(entry.type);
  // Written so that a NaN is refused too.
  if (!(raw >= range.minimum && raw <= range.maximum)) refuse(entry, value);

  if (entry.width() == 1) {
    registers[0] = static_cast<std::uint16_t>(static_cast<std::int32_t>(raw));
    return;
  }
  const std::uint32_t bits = entry.type == RegisterType::f32
                                 ? std::bit_cast<std::uint32_t>(static_cast<float>(raw))
                                 : static_cast<std::uint32_t>(static_cast<std::int64_t>(raw));
  const auto high = static_cast<std::uint16_t>(bits >> 16);
  const auto low = static_cast<std::uint16_t>(bits & 0xFFFFU);
  registers[0] = entry.word_order == WordOrder::big ? high : low;
  registers[1] = entry.word_order == WordOrder::big ? low : high;
}

double decode(const RegisterEntry& entry, std::span<const std::uint16_t> registers) {
  check_room(entry, registers.size());
  if (entry.type == RegisterType::u16) return from_raw(registers[0], entry.scale);
  if (entry.type == RegisterType::i16) {
    return from_raw(static_cast<std::int16_t>(registers[0]), entry.scale);
  }
  const std::uint32_t high = entry.word_order == WordOrder::big ? registers[0] : registers[1];
  const std::uint32_t low = entry.word_order == WordOrder::big ? registers[1] : registers[0];
  const std::uint32_t bits = high << 16 | low;
  if (entry.type == RegisterType::f32) {
    return from_raw(static_cast<double>(std::bit_cast<float>(bits)), entry.scale);
  }
  if (entry.type == RegisterType::i32) {
    return from_raw(static_cast<std::int32_t>(bits), entry.scale);
  }
  return from_raw(bits, entry.scale);
}

}  // namespace biotomy::bridge
