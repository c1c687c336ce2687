#pragma once

#include "acquisition/http/event_feed.hpp"
#include "acquisition/http/http_application.hpp"
#include "acquisition/http/page.hpp"
#include "acquisition/service/service_json.hpp"
#include "acquisition/viewer/sample_api.hpp"

namespace biotomy::acquisition {

/// Serves a sample and the page without a rig: there is nobody to keep out, as whoever may start it
/// may read the files, and no other computer reaches it unless that is asked for.
class SampleService : public HttpApplication {
 public:
  /// All outlive it.
  SampleService(ServiceDescription description, const Page& page, const SampleApi& sample,
                EventFeed& feed);

  Lane lane(const ApiRequest& request) const override;
  ApiResponse answer(const ApiRequest& request) const override;

 private:
  ServiceDescription description_;
  const Page& page_;
  const SampleApi& sample_;
  EventFeed& feed_;
};

}  // namespace biotomy::acquisition
