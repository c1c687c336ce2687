#pragma once

#include <string>

namespace biotomy::reconstruct {

/// `bytes`, such as a file's name, which may be in any encoding, as text that JSON and TOML can
/// hold: what is no UTF-8 in it is replaced by U+FFFD.
std::string utf8_text(const std::string& bytes);

bool is_utf8(const std::string& bytes);

}  // namespace biotomy::reconstruct
