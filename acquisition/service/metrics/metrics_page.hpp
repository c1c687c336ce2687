#pragma once

#include <string>
#include <vector>

#include "acquisition/job/job_status.hpp"
#include "acquisition/service/counted_stage.hpp"
#include "acquisition/service/metrics/run_metrics.hpp"
#include "acquisition/service/notifications/courier.hpp"

namespace biotomy::acquisition {

/// All that /metrics shows, in Prometheus' text format. docs/metrics.md describes each family.
std::string metrics_page(const JobStatus& status, const RunMetrics& run, const LinkCounts& link,
                         const std::vector<Courier::Figures>& couriers);

}  // namespace biotomy::acquisition
