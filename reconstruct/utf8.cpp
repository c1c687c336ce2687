#include "reconstruct/utf8.hpp"

#include <nlohmann/json.hpp>

namespace biotomy::reconstruct {

std::string utf8_text(const std::string& bytes) {
  using nlohmann::json;
  const std::string quoted = json(bytes).dump(-1, ' ', false, json::error_handler_t::replace);
  return json::parse(quoted).get<std::string>();
}

bool is_utf8(const std::string& bytes) {
  return utf8_text(bytes) == bytes;
}

}  // namespace biotomy::reconstruct
