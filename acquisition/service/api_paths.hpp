#pragma once

#include <algorithm>
#include <initializer_list>
#include <memory>
#include <string>
#include <string_view>

#include "acquisition/http/event_feed.hpp"
#include "acquisition/http/message.hpp"

namespace biotomy::acquisition {

// What the daemon and `biotomy view` answer alike.
inline constexpr std::string_view kHealthPath = "/healthz";
inline constexpr std::string_view kServicePath = "/api/v1/service";
inline constexpr std::string_view kEventsPath = "/api/v1/events";
inline constexpr const char* kHealthy = R"({"status":"ok"})";

inline bool is_one_of(std::string_view path, std::initializer_list<std::string_view> paths) {
  return std::find(paths.begin(), paths.end(), path) != paths.end();
}

ApiResponse json_response(std::string body);
ApiResponse event_response(std::shared_ptr<EventSubscription> subscription);

}  // namespace biotomy::acquisition
