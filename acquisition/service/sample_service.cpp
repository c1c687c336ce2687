#include "acquisition/service/sample_service.hpp"

#include <utility>

#include "acquisition/service/api_paths.hpp"

namespace biotomy::acquisition {

SampleService::SampleService(ServiceDescription description, const Page& page,
                             const SampleApi& sample, EventFeed& feed)
    : description_(std::move(description)), page_(page), sample_(sample), feed_(feed) {}

Lane SampleService::lane(const ApiRequest& request) const {
  return sample_.answers(request) ? SampleApi::lane(request) : Lane::quick;
}

ApiResponse SampleService::answer(const ApiRequest& request) const {
  if (sample_.answers(request)) return sample_.answer(request);
  if (page_.answers(request)) return page_.answer(request);
  if (!is_one_of(request.path, {kHealthPath, kServicePath, kEventsPath})) {
    return error_response(404, "there is no " + request.path);
  }
  if (request.method != "GET") return wrong_method(request, "GET");
  if (request.path == kEventsPath) return event_response(feed_.subscribe());
  return json_response(request.path == kHealthPath ? kHealthy : service_json(description_));
}

}  // namespace biotomy::acquisition
