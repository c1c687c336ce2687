#pragma once

#include <cstdint>
#include <string>

#include "reconstruct/sample/sample_folder.hpp"

namespace biotomy::reconstruct {

/// A text that becomes another when one of a sample's first `layers` layer images is replaced,
/// changed or taken away: a SHA-256 of their sizes and times of change. A rebuild of the volume
/// leaves it alone. Looks into no image.
std::string layer_files_state(const SampleFolder& sample, std::int64_t layers);

}  // namespace biotomy::reconstruct
