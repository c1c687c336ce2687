#include "reconstruct/excerpt.hpp"

#include <cstddef>

namespace biotomy::reconstruct {
namespace {

constexpr std::size_t kLongest = 80;

bool continues_a_character(char byte) {
  return (static_cast<unsigned char>(byte) & 0xC0) == 0x80;
}

bool is_control(char byte) {
  const auto code = static_cast<unsigned char>(byte);
  return code < 0x20 || code == 0x7F;
}

}  // namespace

std::string_view beginning_of(std::string_view text, std::size_t most_bytes) {
  std::size_t length = text.size();
  if (length > most_bytes) {
    length = most_bytes;
    while (length > 0 && continues_a_character(text[length])) {
      --length;
    }
  }
  return text.substr(0, length);
}

std::string excerpt(std::string_view text) {
  std::string line(beginning_of(text, kLongest));
  const bool is_whole = line.size() == text.size();
  for (char& byte : line) {
    if (is_control(byte)) {
      byte = '?';
    }
  }
  return is_whole ? line : line + "…";
}

}  // namespace biotomy::reconstruct
