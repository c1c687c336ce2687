#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include <nlohmann/json.hpp>

namespace biotomy::reconstruct {

/// No metadata of a volume is longer; a value takes up to 30 times its text.
inline constexpr std::size_t kMostMetadataBytes = std::size_t{1} << 20;

/// The JSON of a `zarr.json` that may come from anywhere. Throws SampleError, in one line and
/// without the file's name, on what is not JSON and on what no writer of metadata means: more than
/// 1 MiB, values nested deeper than 32, a key that stands twice in one object (readers differ in
/// which of the two they believe), a number that no double holds.
nlohmann::json parse_metadata_json(const std::string& text);

/// A whole number from `least` to `most`. Throws SampleError that begins with `what` on anything
/// else: nlohmann's own conversion cuts off the bits that do not fit.
std::int64_t whole_number(const nlohmann::json& value, const std::string& what, std::int64_t least,
                          std::int64_t most);

}  // namespace biotomy::reconstruct
