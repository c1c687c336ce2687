#include "acquisition/http/request_target.hpp"

#include <algorithm>
#include <charconv>

namespace biotomy::acquisition {
namespace {

constexpr std::size_t kMostParameters = 64;

enum class Plus { is_plus, is_space };

std::optional<std::string> decoded(std::string_view text, Plus plus) {
  std::string result;
  result.reserve(text.size());
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] == '+' && plus == Plus::is_space) {
      result += ' ';
    } else if (text[i] != '%') {
      result += text[i];
    } else {
      const std::string_view digits = text.substr(i + 1, 2);
      unsigned value = 0;
      const auto [end, error] =
          std::from_chars(digits.data(), digits.data() + digits.size(), value, 16);
      if (error != std::errc() || digits.size() != 2 || end != digits.data() + 2) {
        return std::nullopt;
      }
      result += static_cast<char>(value);
      i += 2;
    }
  }
  return result;
}

bool is_unfit(unsigned char character) {
  return character < 0x20U || character == 0x7fU || character == '\\';
}

/// No file below a folder is named so, and no path that leaves one is without it.
bool has_dot_segment(std::string_view path) {
  while (!path.empty()) {
    const std::size_t end = std::min(path.find('/'), path.size());
    const std::string_view segment = path.substr(0, end);
    if (segment == "." || segment == "..") return true;
    path.remove_prefix(std::min(end + 1, path.size()));
  }
  return false;
}

}  // namespace

std::optional<RequestTarget> parse_target(std::string_view text) {
  text = text.substr(0, text.find('#'));
  if (!text.starts_with('/')) return std::nullopt;
  const std::size_t mark = std::min(text.find('?'), text.size());
  std::optional<std::string> path = decoded(text.substr(0, mark), Plus::is_plus);
  if (!path || std::any_of(path->begin(), path->end(), is_unfit) || has_dot_segment(*path)) {
    return std::nullopt;
  }
  RequestTarget target{.path = std::move(*path), .query = {}};
  std::string_view rest = text.substr(std::min(mark + 1, text.size()));
  for (std::size_t count = 0; !rest.empty(); ++count) {
    if (count == kMostParameters) return std::nullopt;
    const std::size_t end = std::min(rest.find('&'), rest.size());
    const std::string_view parameter = rest.substr(0, end);
    rest.remove_prefix(std::min(end + 1, rest.size()));
    if (parameter.empty()) continue;
    const std::size_t equals = std::min(parameter.find('='), parameter.size());
    const auto name = decoded(parameter.substr(0, equals), Plus::is_space);
    const auto value =
        decoded(parameter.substr(std::min(equals + 1, parameter.size())), Plus::is_space);
    if (!name || !value) return std::nullopt;
    target.query[*name] = *value;
  }
  return target;
}

}  // namespace biotomy::acquisition
