#include "acquisition/service/service_json.hpp"

#include <nlohmann/json.hpp>

namespace biotomy::acquisition {

std::string service_json(const ServiceDescription& service) {
  using nlohmann::json;
  const json description = {
      {"version", BIOTOMY_VERSION},
      {"kind", service.kind == ServiceDescription::Kind::rig ? "rig" : "view"},
      {"reading", service.reading_needs_token ? "token" : "open"},
      {"commands_need_token", service.commands_need_token},
      {"sample", service.sample},
      {"neuroglancer", service.neuroglancer.empty() ? json(nullptr) : json(service.neuroglancer)}};
  return description.dump(-1, ' ', false, json::error_handler_t::replace);
}

}  // namespace biotomy::acquisition
