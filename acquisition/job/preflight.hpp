#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>

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

/// The journal's last record lies ahead of the computer's clock.
class ClockBehind : public std::runtime_error {
 public:
  ClockBehind(const std::string& complaint, std::string record_at)
      : std::runtime_error(complaint), record_at_(std::move(record_at)) {}

  const std::string& record_at() const { return record_at_; }

 private:
  std::string record_at_;
};

/// Throws StepFailure when this stage cannot do this job.
void check_stage(const JobSettings& settings, const bridge::StageIdentity& stage);

/// Asks the camera, then begins or opens the sample. To be called by the worker. Throws what they
/// throw, StepFailure when the disk is too full, and ClockBehind unless it is known that the record
/// of that time, `wrong_record`, is wrong.
PreflightFindings inspect(const JobSettings& settings, bridge::Camera& camera,
                          const Surroundings& surroundings, const std::string& wrong_record);

}  // namespace biotomy::acquisition
