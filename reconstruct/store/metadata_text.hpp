#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "reconstruct/store/object_reader.hpp"

namespace biotomy::reconstruct {

/// The name of the metadata of a group and of an array, below it.
inline constexpr const char* kMetadataName = "zarr.json";

/// The text of a `zarr.json`, whole though it may be replaced meanwhile. None when there is no such
/// object. Throws SampleError, naming it, when it cannot be read or is longer than any metadata.
std::optional<std::string> read_metadata_text(ObjectReader& objects, const std::string& name);

/// Of a file that must be there: throws SampleError that says so when it is missing.
std::string read_metadata_file(const std::filesystem::path& file);

}  // namespace biotomy::reconstruct
