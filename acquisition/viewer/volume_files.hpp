#pragma once

#include <filesystem>
#include <string>
#include <utility>

#include "acquisition/http/message.hpp"

namespace biotomy::acquisition {

/// Whether `name` is one that a volume's store has: "zarr.json", "0/zarr.json", "0/c/0/1/2/3".
bool is_volume_name(const std::string& name);

/// The files of a sample's volume for programs that read OME-Zarr over HTTP, in parts too. Nothing
/// else of the sample, and nothing that a link leads to, is ever given.
class VolumeFiles {
 public:
  explicit VolumeFiles(std::filesystem::path volume) : volume_(std::move(volume)) {}

  /// `name` is relative to the volume. Throws Refusal.
  ApiResponse answer(const std::string& name, const ApiRequest& request) const;

 private:
  std::filesystem::path volume_;
};

}  // namespace biotomy::acquisition
