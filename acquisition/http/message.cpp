#include "acquisition/http/message.hpp"

#include <nlohmann/json.hpp>

namespace biotomy::acquisition {

ApiResponse error_response(int status, const std::string& message) {
  const nlohmann::json body = {{"error", {{"code", status}, {"message", message}}}};
  // Names of files need not be UTF-8: what is not becomes a replacement character.
  return {.status = status,
          .body = body.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace)};
}

ApiResponse later_response(int status, const std::string& message, std::chrono::seconds after) {
  ApiResponse response = error_response(status, message);
  response.headers["Retry-After"] = std::to_string(after.count());
  return response;
}

ApiResponse wrong_method(const ApiRequest& request, const std::string& allowed) {
  ApiResponse response =
      error_response(405, request.path + " takes " + allowed + ", not " + request.method);
  response.headers["Allow"] = allowed;
  return response;
}

bool has_already(const ApiRequest& request, const std::string& etag) {
  const std::string& known = request.if_none_match;
  return known == "*" || known.find(etag) != std::string::npos;
}

}  // namespace biotomy::acquisition
