#pragma once

#include <vector>

#include "acquisition/job/job_status.hpp"
#include "acquisition/service/metrics/metric_family.hpp"

namespace biotomy::acquisition {

/// What one status says, as gauges. What is not known (a controller that has not answered yet) has
/// no sample. Always the same families in the same order.
std::vector<MetricFamily> status_metrics(const JobStatus& status);

}  // namespace biotomy::acquisition
