#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>

namespace biotomy::acquisition {

/// What a request's first line asks for: "/a%20b?c=d" is {"/a b", {{"c", "d"}}}.
struct RequestTarget {
  std::string path;
  std::map<std::string, std::string> query;  ///< of a name given twice, the last
};

/// Decodes a target. Nothing when it is none: when it does not begin with a slash, a percent sign
/// is not followed by two hexadecimal digits, the path holds a control character, a backslash or a
/// segment "." or "..", or there are more than 64 parameters.
std::optional<RequestTarget> parse_target(std::string_view text);

}  // namespace biotomy::acquisition
