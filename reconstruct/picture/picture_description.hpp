#pragma once

#include <filesystem>
#include <optional>
#include <string>

namespace biotomy::reconstruct {

/// What a PNG or a TIFF says of itself: the text with the keyword Description (PNG, third edition,
/// section 11.3.3; of the kinds of text the one of `encode_png`, iTXt that is not compressed), or
/// the tag ImageDescription (TIFF 6.0, section 8) of its first page. None where it has none, and of
/// files of other kinds. Reads no pixels. Throws SampleError, naming the file, where it can't be
/// read, is damaged before the text, or says more than 1 MiB.
std::optional<std::string> picture_description(const std::filesystem::path& path);

}  // namespace biotomy::reconstruct
