#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "firmware_bridge/wire/unique_fd.hpp"

namespace biotomy::acquisition {

/// What was asked over HTTP, without a word of HTTP's own framing.
struct ApiRequest {
  std::string method = {};                        ///< "GET", "POST", …; HEAD is asked as GET
  std::string path = {};                          ///< decoded, without the query
  std::map<std::string, std::string> query = {};  ///< decoded; of a name given twice, the last
  std::string authorization = {};  ///< the header's value, here and below; empty if none
  std::string origin = {};
  std::string range = {};
  std::string if_none_match = {};
  std::string if_range = {};
  std::string accept_encoding = {};
  std::string body = {};
  std::string client = {};  ///< the address that it came from
  std::function<bool()> client_left =
      {};                             ///< asked between two pieces of a long work; may be empty
  std::string host = {};              ///< "rig.lab:8080"
  std::string sec_fetch_site = {};    ///< what a browser says of who asks: "same-origin", …
  std::string sec_fetch_mode = {};    ///< "navigate" when a person follows a link
  std::string last_event_id = {};     ///< the last event that the client heard
  bool asks_private_network = false;  ///< of a preflight: may a public page ask this computer?
};

/// A part of an opened file as a response's body; it is read while it is sent, whatever its name
/// comes to mean meanwhile.
struct FilePart {
  std::shared_ptr<const bridge::UniqueFd> file;
  std::uint64_t begin = 0;
  std::uint64_t bytes = 0;
};

class EventSubscription;

struct ApiResponse {
  int status = 200;
  std::string content_type = "application/json";
  std::string body = {};
  std::map<std::string, std::string> headers = {};
  std::optional<FilePart> file = {};               ///< in place of `body`
  std::shared_ptr<EventSubscription> events = {};  ///< in place of `body`: told until one leaves
};

/// What a request asks of the computer: each lane has threads of its own, so that none waits for
/// another kind of work.
enum class Lane {
  commands,  ///< of an operator: no look is before them, and they have the run's own priority
  quick,     ///< looks at memory and a few rows of the journal
  files,     ///< reads parts of files
  pictures   ///< decodes, samples and encodes: bounded, and of lower priority than the run
};

/// {"error": {"code": …, "message": …}}
ApiResponse error_response(int status, const std::string& message);

/// The same of what may be asked again after a while, with the header Retry-After.
ApiResponse later_response(int status, const std::string& message, std::chrono::seconds after);

/// 405: the method is none of `allowed`, "GET, POST".
ApiResponse wrong_method(const ApiRequest& request, const std::string& allowed);

/// Whether the client has exactly this content already, so that 304 is its answer.
bool has_already(const ApiRequest& request, const std::string& etag);

}  // namespace biotomy::acquisition
