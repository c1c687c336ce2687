#pragma once

#include <array>
#include <cstddef>
#include <span>

namespace biotomy::tests {

using FuzzInput = std::span<const std::byte>;

// Each gives the bytes to one reader of ours as a file, or a part of one, that somebody else made.
// The reader may take them or refuse them with an error of its own, in one line that names the
// file; the target throws std::logic_error when it does anything else, and crashes when it does.
// It returns whether the bytes were taken.

bool fuzz_group_metadata(FuzzInput input);
bool fuzz_array_metadata(FuzzInput input);

/// The ranges of an index; its checksum is added, as no fuzzer guesses one.
bool fuzz_shard_index(FuzzInput input);

/// The first byte chooses codec, colours and bits (see chunk_kinds.hpp); a checksum is added to the
/// rest.
bool fuzz_chunk_decode(FuzzInput input);

bool fuzz_sample_description(FuzzInput input);
bool fuzz_layer_image(FuzzInput input);
bool fuzz_parameter_text(FuzzInput input);

/// What a client sends; the first byte is how much of it comes at a time, less one.
bool fuzz_http_request(FuzzInput input);

/// The parameters of /api/v1/section, as a client writes them behind the question mark.
bool fuzz_section_query(FuzzInput input);

/// Likewise of /api/v1/series/frames.
bool fuzz_series_query(FuzzInput input);

/// The body of POST /api/v1/exports.
bool fuzz_export_order(FuzzInput input);

struct FuzzTarget {
  const char* name;  ///< of the folders below corpus/ and regression/
  bool (*run)(FuzzInput);
};

inline constexpr std::array kFuzzTargets{
    FuzzTarget{"group_metadata", fuzz_group_metadata},
    FuzzTarget{"array_metadata", fuzz_array_metadata},
    FuzzTarget{"shard_index", fuzz_shard_index},
    FuzzTarget{"chunk_decode", fuzz_chunk_decode},
    FuzzTarget{"sample_description", fuzz_sample_description},
    FuzzTarget{"layer_image", fuzz_layer_image},
    FuzzTarget{"parameter_text", fuzz_parameter_text},
    FuzzTarget{"http_request", fuzz_http_request},
    FuzzTarget{"section_query", fuzz_section_query},
    FuzzTarget{"series_query", fuzz_series_query},
    FuzzTarget{"export_order", fuzz_export_order},
};

}  // namespace biotomy::tests
