#pragma once

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

/// Whether `name` is one that a volume's store has: "zarr.json", "0/zarr.json", "0/c/0/1/2/3".
bool is_volume_name(const std::string& name);

/// The files of a sample's volume for programs that read OME-Zarr over HTTP, in parts too. Nothing
/// else of the sample, and nothing that a link leads to, is ever given.
class VolumeFiles {
 public:
  /// `origin` is the one page of another server that may read them; empty: none.
  VolumeFiles(std::filesystem::path volume, std::string origin)
      : volume_(std::move(volume)), origin_(std::move(origin)) {}

  /// `name` is relative to the volume. GET and OPTIONS. Throws Refusal.
  ApiResponse answer(const std::string& name, const ApiRequest& request) const;

 private:
  void allow(const ApiRequest& request, ApiResponse& response) const;

  std::filesystem::path volume_;
  std::string origin_;
};

}  // namespace biotomy::acquisition
