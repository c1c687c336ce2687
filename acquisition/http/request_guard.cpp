#include "acquisition/http/request_guard.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <utility>

#include <arpa/inet.h>

#include "acquisition/http/lower_case.hpp"
#include "acquisition/http/own_host_names.hpp"

namespace biotomy::acquisition {
namespace {

constexpr const char* kPolicy =
    "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' blob: data:; "
    "media-src 'self' blob:; connect-src 'self'; font-src 'self'; manifest-src 'self'; "
    "worker-src 'self' blob:; base-uri 'none'; form-action 'none'; frame-ancestors 'none'";
constexpr const char* kPreflightAge = "600";  // seconds
constexpr std::size_t kLongestName = 253;     // of the DNS
constexpr const char* kForeign =
    "another site's page may not ask this; if it is this rig's own page, behind a proxy, the proxy "
    "must pass on the Host that it was asked under";

bool is_address(const std::string& name) {
  std::array<unsigned char, sizeof(in6_addr)> address{};
  return ::inet_pton(AF_INET, name.c_str(), address.data()) == 1 ||
         ::inet_pton(AF_INET6, name.c_str(), address.data()) == 1;
}

bool is_port(std::string_view text) {
  return text.size() <= 5 && std::all_of(text.begin(), text.end(),
                                         [](unsigned char c) { return std::isdigit(c) != 0; });
}

bool is_volume(const ApiRequest& request) {
  return request.path == kVolumePath ||
         (request.path.starts_with(kVolumePath) && request.path[kVolumePath.size()] == '/');
}

/// The origin of the page that this server serves under the name by which it was asked; by https
/// where a proxy stands before it.
bool is_own_origin(const ApiRequest& request) {
  const std::string origin = lower_case(request.origin);
  const std::string host = lower_case(request.host);
  return origin == "http://" + host || origin == "https://" + host;
}

void put(ApiResponse& response, const char* name, const std::string& value) {
  response.headers.try_emplace(name, value);
}

}  // namespace

std::optional<std::string> host_name(std::string_view host) {
  std::string_view name = host;
  std::string_view rest;
  if (host.starts_with('[')) {
    const std::size_t end = host.find(']');
    if (end == std::string_view::npos) return std::nullopt;
    name = host.substr(1, end - 1);
    rest = host.substr(end + 1);
  } else {
    const std::size_t colon = std::min(host.find(':'), host.size());
    name = host.substr(0, colon);
    rest = host.substr(colon);
  }
  if (!rest.empty() && (rest.front() != ':' || !is_port(rest.substr(1)))) return std::nullopt;
  if (name.ends_with('.')) name.remove_suffix(1);
  if (name.empty() || name.size() > kLongestName) return std::nullopt;
  return lower_case(name);
}

bool is_host_name(std::string_view name) {
  const std::optional<std::string> plain = host_name(name);
  return plain && plain->size() == name.size();
}

RequestGuard::RequestGuard(GuardSettings settings) : settings_(std::move(settings)) {
  for (std::string& name : settings_.hosts) name = lower_case(name);
  for (std::string& name : own_host_names()) settings_.hosts.push_back(std::move(name));
  settings_.neuroglancer_origin = lower_case(settings_.neuroglancer_origin);
}

bool RequestGuard::knows_host(std::string_view host) const {
  const std::optional<std::string> name = host_name(host);
  if (!name) return false;
  return is_address(*name) || *name == "localhost" || name->ends_with(".localhost") ||
         std::find(settings_.hosts.begin(), settings_.hosts.end(), *name) != settings_.hosts.end();
}

bool RequestGuard::is_neuroglancer(const ApiRequest& request) const {
  return is_volume(request) && !settings_.neuroglancer_origin.empty() &&
         lower_case(request.origin) == settings_.neuroglancer_origin;
}

std::optional<ApiResponse> RequestGuard::answer(const ApiRequest& request) const {
  if (!knows_host(request.host)) {
    return error_response(421,
                          "this computer is not known by the name it was asked under: use its "
                          "address, or add the name to service.hosts, for biotomy view by --host");
  }
  if (is_neuroglancer(request)) {
    if (request.method == "GET") return std::nullopt;
    if (request.method == "OPTIONS") return ApiResponse{.status = 204, .content_type = {}};
  }
  if (!request.origin.empty() && !is_own_origin(request)) {
    // Some browsers hide the origin even from the page's own server; they still say whose it is.
    const bool hidden = request.origin == "null" && request.sec_fetch_site == "same-origin";
    if (!hidden) return error_response(403, kForeign);
  }
  const bool foreign =
      request.sec_fetch_site == "cross-site" || request.sec_fetch_site == "same-site";
  // A link to the page, from wherever, may be followed.
  const bool followed_link =
      request.method == "GET" && request.path == "/" && request.sec_fetch_mode == "navigate";
  if (foreign && !followed_link) {
    return error_response(403, kForeign);
  }
  return std::nullopt;
}

void RequestGuard::mark(const ApiRequest& request, ApiResponse& response) const {
  put(response, "Content-Security-Policy", kPolicy);
  put(response, "X-Content-Type-Options", "nosniff");
  put(response, "Referrer-Policy", "no-referrer");
  put(response, "Cache-Control", "no-store");
  if (!is_volume(request)) {
    put(response, "Cross-Origin-Opener-Policy", "same-origin");
    put(response, "Cross-Origin-Resource-Policy", "same-origin");
    return;
  }
  put(response, "Vary", "Origin");
  if (!is_neuroglancer(request)) return;
  put(response, "Access-Control-Allow-Origin", request.origin);
  put(response, "Access-Control-Expose-Headers",
      "Accept-Ranges, Content-Length, Content-Range, ETag");
  if (request.method != "OPTIONS") return;
  put(response, "Access-Control-Allow-Methods", "GET, HEAD");
  put(response, "Access-Control-Allow-Headers", "Range, If-None-Match");
  put(response, "Access-Control-Max-Age", kPreflightAge);
  if (request.asks_private_network) put(response, "Access-Control-Allow-Private-Network", "true");
}

}  // namespace biotomy::acquisition
