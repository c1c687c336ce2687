#include "acquisition/quality/metrics_json.hpp"

#include <nlohmann/json.hpp>

namespace biotomy::acquisition {

nlohmann::ordered_json metrics_json(const std::vector<Metric>& metrics) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const Metric& metric : metrics) {
    list.push_back({{"name", metric.name},
                    {"value", metric.value},
                    {"limit", metric.limit},
                    {"passed", metric.passed}});
  }
  return list;
}

}  // namespace biotomy::acquisition
