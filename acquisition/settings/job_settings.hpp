#pragma once

#include "acquisition/focus/focus_settings.hpp"
#include "acquisition/quality/assessment.hpp"
#include "acquisition/settings/calibration_plan.hpp"
#include "acquisition/settings/job_plan.hpp"
#include "acquisition/settings/ladder_settings.hpp"
#include "acquisition/settings/safety_limits.hpp"

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
