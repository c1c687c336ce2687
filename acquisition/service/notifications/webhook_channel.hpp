#pragma once

#include <optional>
#include <string>

#include "acquisition/service/notifications/channel.hpp"

namespace biotomy::acquisition {

struct UrlParts {
  std::string origin;  ///< "https://example.org:8443"
  std::string path;    ///< with the query; at least "/"
};

/// The parts of an http or https URL; nothing when it is none.
std::optional<UrlParts> split_url(const std::string& url);

/// Sends each message by HTTP POST. An answer of 200 to 299 is a delivery; redirections are not
/// followed. Certificates are checked against those that the system trusts. The header
/// Idempotency-Key carries the message's id. Messages of failures name the origin alone: the rest
/// of the URL may be a secret. The program must ignore SIGPIPE: a connection may be cut off while
/// it is written to.
class WebhookChannel final : public Channel {
 public:
  /// `token` is sent as Authorization: Bearer, unless empty.
  WebhookChannel(UrlParts url, std::string token);

  std::string name() const override { return "webhook"; }

  /// The time does not cover looking up the host's name, which the system's resolver bounds.
  void deliver(const std::string& message, std::chrono::milliseconds time_out,
               const std::stop_token& stop) override;

 private:
  UrlParts url_;
  std::string token_;
};

}  // namespace biotomy::acquisition
