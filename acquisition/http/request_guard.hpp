#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "acquisition/http/message.hpp"

namespace biotomy::acquisition {

inline constexpr std::string_view kVolumePath = "/volume.ome.zarr";

struct GuardSettings {
  /// Names under which this computer is asked, beside its own; without a port.
  std::vector<std::string> hosts;
  /// The origin of the only foreign page that may read the volume; empty: none may.
  std::string neuroglancer_origin = "https://neuroglancer-demo.appspot.com";
};

/// Keeps other web sites' pages out of the rig, with the browsers' help. A page that somebody looks
/// at could ask the rig as the person who looks: directly (cross-site requests), or under a name of
/// its own that it lets point to the rig (DNS rebinding). Programs that are no browsers are not
/// held up by it, as long as they ask under a name of the rig.
class RequestGuard {
 public:
  explicit RequestGuard(GuardSettings settings);

  /// Why a request is not let in, or the answer to a browser's question whether it may ask; nothing
  /// when it is let in.
  std::optional<ApiResponse> answer(const ApiRequest& request) const;

  /// Adds to a response what tells a browser who may see it and what a page may do.
  void mark(const ApiRequest& request, ApiResponse& response) const;

 private:
  bool knows_host(std::string_view host) const;
  bool is_neuroglancer(const ApiRequest& request) const;

  GuardSettings settings_;
};

/// Whether `name` can stand among GuardSettings::hosts: a name alone, without a port.
bool is_host_name(std::string_view name);

/// The name in a Host header: lower case, without port and final dot; "[::1]:80" is "::1".
/// Nothing when it is none.
std::optional<std::string> host_name(std::string_view host);

}  // namespace biotomy::acquisition
