#include "acquisition/service/api_paths.hpp"

#include <utility>

namespace biotomy::acquisition {

ApiResponse json_response(std::string body) {
  return {.body = std::move(body)};
}

ApiResponse event_response(std::shared_ptr<EventSubscription> subscription) {
  // A proxy that gathers events until there are many would hold back the news.
  return {.content_type = "text/event-stream",
          .headers = {{"X-Accel-Buffering", "no"}},
          .events = std::move(subscription)};
}

}  // namespace biotomy::acquisition
