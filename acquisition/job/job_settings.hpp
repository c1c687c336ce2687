#pragma once

#include "acquisition/calibration/calibration_plan.hpp"
#include "acquisition/focus/focus_settings.hpp"
#include "acquisition/job/job_plan.hpp"
#include "acquisition/job/quality_ladder.hpp"
#include "acquisition/job/safety_limits.hpp"
#include "acquisition/quality/assessment.hpp"

namespace biotomy::acquisition {

/// All that decides how a job runs.
struct JobSettings {
  JobPlan plan;
  CameraPlan camera;
  CalibrationPlan calibration;
  FocusSettings focus;
  QualityThresholds thresholds;
  LadderSettings ladder;
  StorePlan store;
  SafetyLimits limits;
};

}  // namespace biotomy::acquisition
