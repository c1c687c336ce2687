#pragma once

#include <string>

namespace biotomy::acquisition {

/// What a page has to know before it asks for anything that may need a token.
struct ServiceDescription {
  enum class Kind { rig, view } kind = Kind::rig;
  bool reading_needs_token = false;
  bool commands_need_token = true;
  std::string sample;        ///< its name
  std::string neuroglancer;  ///< the address of neuroglancer's page; empty if it may not read here
};

/// The JSON of GET /api/v1/service.
std::string service_json(const ServiceDescription& service);

}  // namespace biotomy::acquisition
