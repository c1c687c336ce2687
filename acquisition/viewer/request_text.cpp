#include "acquisition/viewer/request_text.hpp"

#include <algorithm>
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

std::vector<std::string> words_between(std::string_view text, char separator) {
  std::vector<std::string> words;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find(separator, begin), text.size());
    words.emplace_back(text.substr(begin, end - begin));
    begin = end + 1;
  }
  return words;
}

}  // namespace biotomy::acquisition
