#pragma once

#include <filesystem>
#include <stdexcept>
#include <string>
#include <string_view>

namespace biotomy::acquisition {

/// The token file cannot be made, read or trusted.
class AccessError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// The token that commands must carry. A missing file is made, readable by its owner alone, with
/// 256 random bits in hexadecimal. A file that others can read is refused. Throws AccessError.
std::string read_or_make_token(const std::filesystem::path& file);

enum class Access { granted, no_token, wrong_token };

/// What the value of an Authorization header ("Bearer …") opens. The comparison takes the same time
/// whatever the token is.
Access check_access(std::string_view authorization, std::string_view token);

}  // namespace biotomy::acquisition
