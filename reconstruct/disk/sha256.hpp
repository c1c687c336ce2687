#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>

namespace biotomy::reconstruct {

/// SHA-256 (FIPS 180-4), in lower-case hexadecimal. Throws SampleError where OpenSSL fails.
std::string sha256(std::span<const std::byte> bytes);

/// Likewise, of a file's content; also where the file cannot be read, with its name.
std::string sha256_of_file(const std::filesystem::path& path);

}  // namespace biotomy::reconstruct
