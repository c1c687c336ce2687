#pragma once

#include <cstdint>
#include <filesystem>

#include "acquisition/job/job_status.hpp"
#include "acquisition/settings/safety_limits.hpp"

namespace biotomy::acquisition {

/// How many of a disk's `free` bytes the run does not need, on the disk of the sample: all its
/// layers to come, and no fewer than `safety.disk_reserve_layers`. Half of them as long as nobody
/// knows how large a layer is.
std::uint64_t bytes_to_spare(std::uint64_t free, const JobStatus& status,
                             const SafetyLimits& limits);

/// The same of the disk that holds `folder` or will hold it; on another disk than the sample's all
/// but a gibibyte is to spare.
std::uint64_t bytes_to_spare(const std::filesystem::path& folder,
                             const std::filesystem::path& sample, const JobStatus& status,
                             const SafetyLimits& limits);

}  // namespace biotomy::acquisition
