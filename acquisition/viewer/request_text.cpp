#include "acquisition/viewer/request_text.hpp"

#include <charconv>

#include "reconstruct/errors.hpp"

namespace biotomy::acquisition {

std::optional<std::int64_t> whole_number(std::string_view text, std::int64_t least,
                                         std::int64_t most) {
  std::int64_t value = 0;
  const char* const end = text.data() + text.size();
  const auto [stopped, error] = std::from_chars(text.data(), end, value);
  if (error != std::errc() || stopped != end || text.front() == '-') return std::nullopt;
  if (value < least || value > most) return std::nullopt;
  return value;
}

std::int64_t number_in(const ApiRequest& request, const std::string& name, std::int64_t fallback,
                       std::int64_t least, std::int64_t most, const std::string& wanted) {
  const auto found = request.query.find(name);
  if (found == request.query.end()) return fallback;
  const auto value = whole_number(found->second, least, most);
  if (!value) throw reconstruct::InvalidRequest(name + " must be " + wanted);
  return *value;
}

bool has_already(const ApiRequest& request, const std::string& etag) {
  const std::string& known = request.if_none_match;
  return known == "*" || known.find(etag) != std::string::npos;
}

}  // namespace biotomy::acquisition
