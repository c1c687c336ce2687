#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "acquisition/http/message.hpp"

namespace biotomy::acquisition {

/// The bytes of a file that a header `Range` asks for.
struct ByteRange {
  std::uint64_t begin = 0;
  std::uint64_t bytes = 0;

  friend bool operator==(const ByteRange&, const ByteRange&) = default;
};

/// Of a file of `size` bytes (RFC 9110, section 14): all of it where the header is empty, is not
/// understood or asks for several parts, which a server may answer so; nothing where it asks for
/// what the file does not have.
std::optional<ByteRange> byte_range(const std::string& header, std::uint64_t size);

/// A file that is there, whole or the part that was asked for, with its tag: 200, 206, 304 or 416.
/// Whole, too, where the part was to go on with another content (If-Range).
ApiResponse file_response(const ApiRequest& request, const std::filesystem::path& file,
                          const std::string& content_type);

}  // namespace biotomy::acquisition
