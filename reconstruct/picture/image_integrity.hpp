#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>

namespace biotomy::reconstruct {

/// What is wrong with a PNG file, if anything: its chunks must follow each other up to IEND, each
/// with the right CRC (PNG, third edition, section 5). A file that passes is whole.
std::optional<std::string> png_damage(std::span<const std::byte> file);

/// What is wrong with a JPEG file, if anything: its segments and scans must follow each other up to
/// the end-of-image marker (ITU-T T.81, annex B). JPEG has no checksums: that it is whole can be
/// told, that no byte of it changed cannot.
std::optional<std::string> jpeg_damage(std::span<const std::byte> file);

}  // namespace biotomy::reconstruct
