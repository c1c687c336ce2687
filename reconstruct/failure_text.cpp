#include "reconstruct/failure_text.hpp"

#include <new>
#include <string_view>

namespace biotomy::reconstruct {

std::string failure_text(const std::exception& error) {
  if (dynamic_cast<const std::bad_alloc*>(&error) != nullptr) {
    return "there is not enough memory";
  }
  std::string line;
  const std::string_view text = error.what();
  for (const char byte : text) {
    const bool ends_a_line = byte == '\n' || byte == '\r';
    if (!ends_a_line) {
      line += byte;
    } else if (!line.empty() && line.back() != ' ') {
      line += ' ';
    }
  }
  return line.substr(0, line.find_last_not_of(' ') + 1);
}

}  // namespace biotomy::reconstruct
