#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "acquisition/records/recalled_faces.hpp"
#include "acquisition/records/sample_records.hpp"
#include "acquisition/records/surroundings.hpp"
#include "acquisition/settings/job_settings.hpp"
#include "firmware_bridge/camera/camera.hpp"
#include "firmware_bridge/stage/stage.hpp"

namespace biotomy::acquisition {

/// What the worker found out of camera, sample and disk.
struct PreflightFindings {
  bridge::CameraDescription camera;
  std::shared_ptr<SampleRecords> records;
  JournalSummary journal;
  std::int64_t disk_left_layers = 0;
  RecalledFaces recalled;  ///< of the layers that are committed
};

/// Throws StepFailure when this stage cannot do this job.
void check_stage(const JobSettings& settings, const bridge::StageIdentity& stage);

/// Asks the camera, then begins or opens the sample. To be called by the worker. Throws what they
/// throw, and StepFailure when the disk is too full.
PreflightFindings inspect(const JobSettings& settings, bridge::Camera& camera,
                          const Surroundings& surroundings);

}  // namespace biotomy::acquisition
