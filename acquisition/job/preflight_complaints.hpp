#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "acquisition/records/journal_rows.hpp"
#include "acquisition/settings/job_settings.hpp"
#include "firmware_bridge/camera/camera.hpp"
#include "firmware_bridge/stage/stage.hpp"

namespace biotomy::acquisition {

/// Why a job cannot begin, each in one sentence that says what to do; none when all is well.
/// The preflight of a job stops at the first, `biotomyd --check` shows all.
using Complaints = std::vector<std::string>;

/// Why this stage cannot do this job.
Complaints stage_complaints(const JobSettings& settings, const bridge::StageIdentity& stage);

/// Why this camera cannot do it, by what it says of itself.
Complaints camera_complaints(const JobSettings& settings, const bridge::CameraDescription& camera);

/// What is wrong with a trial frame, whatever it shows: better now than with a block that is
/// ground.
Complaints frame_complaints(const JobSettings& settings, const bridge::CameraDescription& camera,
                            const bridge::Frame& frame);

/// Records would have wrong times for ever. `last_event_at` is the journal's last record, empty
/// without one.
Complaints clock_complaints(std::chrono::system_clock::time_point now,
                            const std::string& last_event_at);

/// Not enough room for the layers to come.
Complaints disk_complaints(const JobSettings& settings, std::int64_t disk_left_layers,
                           std::int64_t last_committed);

/// How the camera is set, which is the same for all layers: else a change of the light could not be
/// told from a change of the tissue.
std::vector<Constant> constants_of(const bridge::CameraSettings& settings,
                                   const bridge::CameraDescription& camera);

}  // namespace biotomy::acquisition
