#pragma once

#include <filesystem>
#include <optional>
#include <stdexcept>
#include <string>

namespace biotomy::acquisition {

/// A file with a secret cannot be made, read or trusted.
class SecretFileError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// The text of a file that only its owner may know: a regular file, no link, of at most 64 KiB,
/// owned by the daemon's user or by root, and without any right for group and others.
/// `what` names the file in messages: "the token file". Throws SecretFileError.
std::string read_secret_file(const std::filesystem::path& file, const std::string& what);

/// Makes such a file durably, unless there is one already: then false. Throws SecretFileError.
bool make_secret_file(const std::filesystem::path& file, const std::string& what,
                      const std::string& text);

}  // namespace biotomy::acquisition
