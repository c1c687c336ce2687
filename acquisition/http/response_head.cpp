#include "acquisition/http/response_head.hpp"

#include <algorithm>
#include <array>
#include <ctime>

namespace biotomy::acquisition {
namespace {

constexpr int kNoContent = 204;
constexpr int kNotModified = 304;

const char* reason_phrase(int status) {
  struct Phrase {
    int status;
    const char* text;
  };
  static constexpr std::array kPhrases = {
      Phrase{200, "OK"},
      Phrase{202, "Accepted"},
      Phrase{204, "No Content"},
      Phrase{206, "Partial Content"},
      Phrase{304, "Not Modified"},
      Phrase{400, "Bad Request"},
      Phrase{401, "Unauthorized"},
      Phrase{403, "Forbidden"},
      Phrase{404, "Not Found"},
      Phrase{405, "Method Not Allowed"},
      Phrase{408, "Request Timeout"},
      Phrase{409, "Conflict"},
      Phrase{411, "Length Required"},
      Phrase{413, "Content Too Large"},
      Phrase{414, "URI Too Long"},
      Phrase{416, "Range Not Satisfiable"},
      Phrase{421, "Misdirected Request"},
      Phrase{422, "Unprocessable Content"},
      Phrase{429, "Too Many Requests"},
      Phrase{431, "Request Header Fields Too Large"},
      Phrase{500, "Internal Server Error"},
      Phrase{503, "Service Unavailable"},
      Phrase{507, "Insufficient Storage"},
  };
  for (const Phrase& phrase : kPhrases) {
    if (phrase.status == status) return phrase.text;
  }
  return "";
}

std::string http_date() {
  const std::time_t now = std::time(nullptr);
  std::tm parts{};
  ::gmtime_r(&now, &parts);
  std::array<char, 40> text{};
  std::strftime(text.data(), text.size(), "%a, %d %b %Y %H:%M:%S GMT", &parts);
  return text.data();
}

/// A value that came from elsewhere must not begin another header.
void add(std::string& head, std::string_view name, std::string_view value) {
  head.append(name).append(": ");
  std::copy_if(value.begin(), value.end(), std::back_inserter(head),
               [](unsigned char c) { return c >= 0x20U && c != 0x7fU; });
  head.append("\r\n");
}

}  // namespace

std::string response_head(const ApiResponse& response, std::optional<std::uint64_t> length,
                          bool keep_alive) {
  std::string head =
      "HTTP/1.1 " + std::to_string(response.status) + " " + reason_phrase(response.status) + "\r\n";
  add(head, "Date", http_date());
  const bool has_body = response.status != kNoContent && response.status != kNotModified;
  if (has_body) {
    add(head, "Content-Type", response.content_type);
    if (length) add(head, "Content-Length", std::to_string(*length));
  }
  add(head, "Connection", keep_alive && (length || !has_body) ? "keep-alive" : "close");
  for (const auto& [name, value] : response.headers) add(head, name, value);
  return head + "\r\n";
}

}  // namespace biotomy::acquisition
