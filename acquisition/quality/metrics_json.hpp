#pragma once

#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "acquisition/quality/assessment.hpp"

namespace biotomy::acquisition {

/// As journal, status and `biotomy qc` give metrics: [{name, value, limit, passed}, …].
nlohmann::ordered_json metrics_json(const std::vector<Metric>& metrics);

}  // namespace biotomy::acquisition
