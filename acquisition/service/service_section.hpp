#pragma once

#include <chrono>
#include <filesystem>
#include <string>

#include "acquisition/http/http_settings.hpp"
#include "acquisition/service/access.hpp"
#include "acquisition/viewer/viewer_settings.hpp"
#include "firmware_bridge/wire/checked_table.hpp"

namespace biotomy::acquisition {

struct ServiceConfiguration {
  std::string host = "127.0.0.1";
  int port = 8080;
  std::filesystem::path token_file;
  AccessSettings access;
  HttpSettings http;
  ViewerSettings viewer;
  std::chrono::milliseconds tick{20};
  std::chrono::milliseconds stop_limit{120000};
  std::chrono::milliseconds device_wait{120000};  ///< at the daemon's start, for what is missing
};

/// [service] of rig.toml. Reading for everybody is refused on an address that other computers
/// reach, unless `allow_remote` says that it is meant.
ServiceConfiguration read_service(const bridge::CheckedTable& table);

}  // namespace biotomy::acquisition
