#pragma once

#include <cstdint>
#include <initializer_list>
#include <vector>

namespace biotomy::tests {

/// Bytes as USB wants them: numbers of more than one byte begin with the least.
class UsbBytes {
 public:
  UsbBytes& u8(std::initializer_list<unsigned> values) {
    for (const unsigned value : values) bytes_.push_back(static_cast<std::uint8_t>(value));
    return *this;
  }
  UsbBytes& u16(unsigned value) { return u8({value & 0xffU, value >> 8U & 0xffU}); }
  UsbBytes& u32(std::uint32_t value) { return u16(value & 0xffffU).u16(value >> 16U); }
  UsbBytes& append(const std::vector<std::uint8_t>& others) {
    bytes_.insert(bytes_.end(), others.begin(), others.end());
    return *this;
  }
  std::uint32_t size() const { return static_cast<std::uint32_t>(bytes_.size()); }
  const std::vector<std::uint8_t>& get() const { return bytes_; }

 private:
  std::vector<std::uint8_t> bytes_;
};

}  // namespace biotomy::tests
