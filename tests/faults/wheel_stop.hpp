#pragma once

#include <chrono>
#include <filesystem>
#include <optional>
#include <string>

namespace biotomy::tests {

/// How long after `since` the wheel was told to stop, whoever told it; nothing when it was not,
/// until `until`: it stood. Times are ISO 8601, UTC. `time_scale`: the twin's.
std::optional<std::chrono::milliseconds> wheel_told_to_stop(const std::filesystem::path& witness,
                                                            const std::string& since,
                                                            const std::string& until,
                                                            double time_scale);

}  // namespace biotomy::tests
