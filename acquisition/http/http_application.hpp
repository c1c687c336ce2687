#pragma once

#include "acquisition/http/message.hpp"

namespace biotomy::acquisition {

/// What an HttpServer serves. Many threads ask at once.
class HttpApplication {
 public:
  HttpApplication() = default;
  HttpApplication(const HttpApplication&) = delete;
  HttpApplication& operator=(const HttpApplication&) = delete;
  virtual ~HttpApplication() = default;

  /// Which threads a request is for. It looks at the request alone, and at once.
  virtual Lane lane(const ApiRequest& request) const = 0;

  /// What it throws is logged, and answered with status 500.
  virtual ApiResponse answer(const ApiRequest& request) const = 0;
};

}  // namespace biotomy::acquisition
