#pragma once

#include <optional>
#include <string>

#include "acquisition/job/job_status.hpp"
#include "acquisition/records/journal_rows.hpp"
#include "acquisition/settings/safety_limits.hpp"

namespace biotomy::acquisition {

/// What the status tells beside the job's own.
struct StatusContext {
  SafetyLimits limits;
  std::optional<AttemptNote> last_attempt;  ///< the last that the journal holds
};

/// The JSON of GET /api/v1/status.
std::string status_json(const JobStatus& status, const StatusContext& context);

/// {"accepted": true, "message": …}
std::string reply_json(const std::string& message);

}  // namespace biotomy::acquisition
