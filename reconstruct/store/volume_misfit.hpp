#pragma once

#include <optional>
#include <string>

#include "reconstruct/geometry/cuboid.hpp"
#include "reconstruct/sample/sample_folder.hpp"

namespace biotomy::reconstruct {

/// In what a volume of these voxels is not the one that the sample's description tells of, as one
/// of the two was changed: each value with both its numbers, under its key in `sample.toml`, and
/// the remedy. To stand behind the volume's name and a colon. Nothing when they fit.
std::optional<std::string> misfit(const Cuboid& cuboid, int bits, const SampleFolder& sample);

}  // namespace biotomy::reconstruct
