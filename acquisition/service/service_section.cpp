#include "acquisition/service/service_section.hpp"

#include "acquisition/http/listen_address.hpp"
#include "acquisition/service/configuration_keys.hpp"

namespace biotomy::acquisition {
namespace {

using bridge::CheckedTable;
using bridge::FlagKey;
using bridge::TextKey;
using bridge::TextsKey;

constexpr int kMegabyte = 1'000'000;

void read_listen(const CheckedTable& table, ServiceConfiguration& service) {
  const std::string listen =
      table.get(TextKey{.name = "listen",
                        .fallback = "127.0.0.1:8080",
                        .description = "address and port of the web page and the API"});
  const std::optional<ListenAddress> address = parse_listen_address(listen);
  if (!address) {
    table.reject("listen", "\"" + listen + "\" is not possible; expected \"address:port\"");
  }
  service.host = address->host;
  service.port = address->port;
}

/// An origin as browsers tell it: a scheme and a host, without a path.
bool is_origin(const std::string& text) {
  const std::size_t scheme = text.find("://");
  if (scheme == std::string::npos || text.find('/', scheme + 3) != std::string::npos) return false;
  const std::string name = text.substr(0, scheme);
  return (name == "https" || name == "http") && host_name(text.substr(scheme + 3));
}

void read_foreigners(const CheckedTable& table, ServiceConfiguration& service) {
  service.http.guard.hosts = table.get(
      TextsKey{.name = "hosts",
               .fallback = std::vector<std::string>{},
               .description = "names by which browsers ask this computer, beside its address, "
                              "\"localhost\" and its own name; under any other they get nothing"});
  for (const std::string& name : service.http.guard.hosts) {
    if (!is_host_name(name)) {
      table.reject("hosts", "\"" + name + "\" is not possible; expected a name without a port");
    }
  }
  const std::string neuroglancer = table.get(
      TextKey{.name = "neuroglancer",
              .fallback = service.http.guard.neuroglancer_origin,
              .may_be_empty = true,
              .description = "the one foreign page that may read the volume, neuroglancer's; "
                             "empty: none may"});
  if (!neuroglancer.empty() && !is_origin(neuroglancer)) {
    table.reject("neuroglancer", "\"" + neuroglancer +
                                     "\" is not possible; expected \"https://name\", without a "
                                     "path");
  }
  service.http.guard.neuroglancer_origin = neuroglancer;
}

void read_bounds(const CheckedTable& table, ServiceConfiguration& service) {
  HttpLimits& limits = service.http.limits;
  limits.connections =
      static_cast<std::size_t>(count(table, "connections", static_cast<int>(limits.connections), 8,
                                     10000, "at the same time; each open page has one or more"));
  limits.connections_of_an_address = static_cast<std::size_t>(
      count(table, "connections_of_an_address", static_cast<int>(limits.connections_of_an_address),
            4, 10000, "the same of one address, or of all behind one proxy"));
  limits.pictures_per_second =
      count(table, "pictures_per_second", limits.pictures_per_second, 1, 1000,
            "sections and images that one address may ask for; three times as many at once");
  service.viewer.cache_bytes =
      static_cast<std::size_t>(count(table, "cache_mb",
                                     static_cast<int>(service.viewer.cache_bytes / kMegabyte), 16,
                                     100000, "of the volume, kept in memory to cut sections")) *
      kMegabyte;
  const std::string exports = optional_text(
      table, "exports",
      "folder of the pictures and films that are made for download; empty: beside the sample");
  if (!exports.empty()) service.viewer.exports = table.resolve(exports);
}

}  // namespace

ServiceConfiguration read_service(const CheckedTable& table) {
  ServiceConfiguration service;
  read_listen(table, service);
  service.token_file = table.resolve(
      table.get(TextKey{.name = "token_file",
                        .fallback = "biotomy.token",
                        .description = "holds the token that commands must carry, or a line "
                                       "\"name token\" for each person; made when missing"}));
  service.access.reading_needs_token =
      table.get(TextKey{.name = "read",
                        .fallback = "open",
                        .choices = {"open", "token"},
                        .description = "who may look at status, layers, sections and metrics: "
                                       "everybody who reaches the address, or who has a token"}) ==
      "token";
  const bool allow_remote =
      table.get(FlagKey{.name = "allow_remote",
                        .fallback = false,
                        .description = "listen on an address that other computers reach although "
                                       "reading needs no token"});
  if (!is_loopback(service.host) && !service.access.reading_needs_token && !allow_remote) {
    table.reject("listen", "other computers reach " + service.host +
                               ", and everybody could read there: set service.read = \"token\", or "
                               "service.allow_remote = true if that is meant");
  }
  service.access.failed_tokens_per_minute =
      count(table, "failed_tokens_per_minute", service.access.failed_tokens_per_minute, 1, 1000,
            "of one address; after more wrong tokens it has to wait");
  service.access.commands_per_minute =
      count(table, "commands_per_minute", service.access.commands_per_minute, 1, 10000,
            "of one address; after more commands it has to wait");
  read_foreigners(table, service);
  read_bounds(table, service);
  service.tick =
      duration(table, "tick_ms", service.tick, "the rig is looked after so often", 1, 200);
  service.stop_limit = duration(table, "stop_limit_ms", service.stop_limit,
                                "when the daemon is told to end: time to come to rest");
  service.device_wait =
      duration(table, "device_wait_ms", service.device_wait,
               "at the daemon's start: time for devices and name server to be there, as after a "
               "power cut; then it ends, and systemd starts it again; 0: it ends at once",
               0);
  return service;
}

}  // namespace biotomy::acquisition
