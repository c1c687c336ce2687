#pragma once

#include <cstdint>
#include <filesystem>

#include "acquisition/job/job_status.hpp"

namespace biotomy::acquisition {

/// Bytes of `free` that the job leaves over: it needs room for the layers that are not committed
/// yet, and for `reserve_layers` more. All but 1 GiB as long as nobody knows what a layer takes.
std::uint64_t bytes_left_by_job(const JobStatus& status, std::int64_t reserve_layers,
                                std::uint64_t free);

/// Bytes that exports may take where they lie: what the job leaves over on the sample's own disk,
/// all but 1 GiB on another one.
std::uint64_t room_for_exports(const std::filesystem::path& exports,
                               const std::filesystem::path& sample, const JobStatus& status,
                               std::int64_t reserve_layers);

}  // namespace biotomy::acquisition
