#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "acquisition/service/secret_file.hpp"

namespace biotomy::acquisition {

/// The tokens that open the rig, each with the name of whoever it was given to. Only digests of
/// them are kept.
class Credentials {
 public:
  /// A file holds one token alone, whose owner is then called "operator", or lines of
  /// `name token`; lines that begin with # and empty ones say nothing. A missing file is made,
  /// readable by its owner alone, with one token of 256 random bits in hexadecimal.
  /// Throws SecretFileError, also for a token under 16 characters.
  static Credentials read_or_make(const std::filesystem::path& file);

  /// The same of a file that is there.
  static Credentials read(const std::filesystem::path& file);

  /// The same from the file's text; `file` stands for its name.
  static Credentials parse(const std::string& text, const std::string& file);

  /// Whose token it is; nothing when it is nobody's. Takes the same time for every token of one
  /// length.
  std::optional<std::string> owner_of(std::string_view token) const;

 private:
  using Digest = std::array<unsigned char, 32>;  // SHA-256
  struct Credential {
    std::string name;
    Digest digest;
  };
  static Digest digest_of(std::string_view token);

  std::vector<Credential> credentials_;
};

}  // namespace biotomy::acquisition
