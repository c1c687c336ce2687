#include <algorithm>
#include <set>
#include <string>

#include "acquisition/http/request_guard.hpp"
#include "acquisition/http/request_reader.hpp"
#include "acquisition/http/response_head.hpp"
#include "tests/fuzz/fuzz_targets.hpp"
#include "tests/fuzz/refusal.hpp"

namespace biotomy::tests {
namespace {

using namespace acquisition;

/// Answers with all that it was asked, as an application might.
ApiResponse echo(const ApiRequest& request) {
  ApiResponse response{.body = request.body};
  response.headers["Biotomy-Echo"] = request.path + request.authorization + request.origin;
  for (const auto& [name, value] : request.query) response.headers["Biotomy-Query"] += name + value;
  return response;
}

void require_decent_path(const std::string& path) {
  require(path.starts_with('/'), "a path begins without a slash");
  require((path + "/").find("/../") == std::string::npos, "a path leads up");
  require(std::none_of(path.begin(), path.end(),
                       [](unsigned char c) { return c < 0x20U || c == 0x7fU || c == '\\'; }),
          "a path holds what no name should");
}

/// One head, whatever was asked: its only empty line is its last.
void require_one_head(const std::string& head) {
  require(head.starts_with("HTTP/1.1 ") && head.find("\r\n\r\n") == head.size() - 4,
          "a response has more than one head");
  for (std::size_t at = head.find('\n'); at != std::string::npos; at = head.find('\n', at + 1)) {
    require(at > 0 && head[at - 1] == '\r', "a header was begun from elsewhere");
  }
}

}  // namespace

bool fuzz_http_request(FuzzInput input) {
  static const RequestGuard guard({.hosts = {"rig.lab"}});
  if (input.empty()) return false;
  const std::size_t piece = 1 + std::to_integer<std::size_t>(input.front());
  const std::string text(reinterpret_cast<const char*>(input.data()) + 1, input.size() - 1);
  RequestReader reader;
  std::string waiting;
  bool taken = false;
  for (std::size_t begin = 0; begin < text.size(); begin += piece) {
    waiting += text.substr(begin, piece);
    while (true) {
      const RequestReader::Outcome outcome = reader.take(waiting);
      if (outcome == RequestReader::Outcome::refused) {
        static const std::set<int> kRefusals = {400, 411, 413, 414, 431};
        require(kRefusals.contains(reader.refusal().status), "refused with another status");
        return taken;
      }
      reader.take_expectation();
      if (outcome == RequestReader::Outcome::needs_more) {
        require(waiting.size() <= kLongestHeader, "more is kept than a header may have");
        break;
      }
      taken = true;
      const ReceivedRequest received = reader.request();
      require_decent_path(received.request.path);
      require(received.request.body.size() <= kLargestBody, "a body is too large");
      ApiResponse response = guard.answer(received.request).value_or(echo(received.request));
      guard.mark(received.request, response);
      require_one_head(response_head(response, response.body.size(), received.keep_alive));
    }
  }
  return taken;
}

}  // namespace biotomy::tests
