#include "acquisition/service/notifications/webhook_channel.hpp"

#include <algorithm>
#include <condition_variable>
#include <mutex>
#include <thread>
#include <utility>

#include <httplib.h>
#include <nlohmann/json.hpp>

namespace biotomy::acquisition {
namespace {

constexpr std::size_t kLongestReason = 200;

/// Cuts the connection off at the deadline, or when the daemon stops: the library's own time-outs
/// begin anew with each byte that a slow server sends.
class CutOff {
 public:
  CutOff(httplib::Client& client, std::chrono::milliseconds time_out, const std::stop_token& stop)
      : thread_([this, &client, time_out, stop](const std::stop_token& finished) {
          const std::stop_callback wake_for_stop(stop, [this] { wake(); });
          const std::stop_callback wake_for_end(finished, [this] { wake(); });
          std::unique_lock lock(mutex_);
          changed_.wait_for(lock, time_out,
                            [&] { return finished.stop_requested() || stop.stop_requested(); });
          // Again and again: a connection that is only being made cannot be cut off yet.
          while (!finished.stop_requested()) {
            client.stop();
            changed_.wait_for(lock, kAgain, [&] { return finished.stop_requested(); });
          }
        }) {}

 private:
  static constexpr std::chrono::milliseconds kAgain{50};

  void wake() {
    { const std::scoped_lock lock(mutex_); }
    changed_.notify_all();
  }

  std::mutex mutex_;
  std::condition_variable changed_;
  std::jthread thread_;
};

/// Statuses by which a server says that it is the content that it does not take (RFC 9110).
bool is_about_the_content(int status) {
  constexpr int kBadRequest = 400;
  constexpr int kContentTooLarge = 413;
  constexpr int kUnprocessableContent = 422;
  return status == kBadRequest || status == kContentTooLarge || status == kUnprocessableContent;
}

std::string first_line(std::string text) {
  text.erase(std::min({text.find_first_of("\r\n"), text.size(), kLongestReason}));
  return text;
}

}  // namespace

std::optional<UrlParts> split_url(const std::string& url) {
  const std::string scheme = url.starts_with("https://") ? "https://" : "http://";
  if (!url.starts_with(scheme)) return std::nullopt;
  const bool odd =
      std::any_of(url.begin(), url.end(), [](unsigned char c) { return c <= ' ' || c == 127; });
  const std::size_t end = std::min(url.find_first_of("/?#", scheme.size()), url.size());
  const std::string host = url.substr(scheme.size(), end - scheme.size());
  if (odd || host.empty() || host.find('@') != std::string::npos) return std::nullopt;
  std::string path = url.substr(end, url.find('#') - end);
  if (path.empty() || path.front() != '/') path.insert(0, "/");
  return UrlParts{scheme + host, std::move(path)};
}

WebhookChannel::WebhookChannel(UrlParts url, std::string token)
    : url_(std::move(url)), token_(std::move(token)) {}

void WebhookChannel::deliver(const std::string& message, std::chrono::milliseconds time_out,
                             const std::stop_token& stop) {
  httplib::Client client(url_.origin);
  if (!client.is_valid()) throw DeliveryError(url_.origin + " is no address to send to");
  client.set_connection_timeout(time_out);
  client.set_read_timeout(time_out);
  client.set_write_timeout(time_out);
  client.set_follow_location(false);
  httplib::Request request;
  request.method = "POST";
  request.path = url_.path;
  request.body = message;
  request.set_header("Content-Type", "application/json");
  request.set_header("User-Agent", std::string("biotomyd/") + BIOTOMY_VERSION);
  request.set_header("Idempotency-Key", nlohmann::json::parse(message).at("id").get<std::string>());
  if (!token_.empty()) request.set_header("Authorization", "Bearer " + token_);
  int status = 0;
  request.response_handler = [&status](const httplib::Response& response) {
    status = response.status;
    return true;
  };
  // Of what the server says only the beginning is taken, however much it is.
  std::string words;
  request.content_receiver = [&words](const char* data, std::size_t length, std::uint64_t,
                                      std::uint64_t) {
    words.append(data, length);
    return words.size() < kLongestReason;
  };
  const httplib::Result result = [&] {
    const CutOff cut_off(client, time_out, stop);
    return client.send(request);
  }();
  // An answer without a body is not shown to the handler.
  if (result) status = result->status;
  if (status == 0) {
    if (stop.stop_requested()) throw DeliveryError(url_.origin + " was given up with the daemon");
    if (result.error() == httplib::Error::SSLServerVerification) {
      throw DeliveryError(url_.origin + " shows a certificate that this computer does not trust");
    }
    throw DeliveryError(url_.origin + " does not answer: " + httplib::to_string(result.error()));
  }
  if (status < 200 || status > 299) {
    const std::string answer =
        url_.origin + " answers with status " + std::to_string(status) + ": " + first_line(words);
    if (is_about_the_content(status)) throw MessageRefused(answer);
    throw DeliveryError(answer);
  }
}

}  // namespace biotomy::acquisition
