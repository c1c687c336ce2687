#pragma once

#include <chrono>
#include <stdexcept>
#include <stop_token>
#include <string>

namespace biotomy::acquisition {

/// A message did not reach its receiver; the text says why.
class DeliveryError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// The receiver is there, and does not take this message; another one it may.
class MessageRefused : public DeliveryError {
 public:
  using DeliveryError::DeliveryError;
};

/// A way by which messages reach a person.
class Channel {
 public:
  virtual ~Channel() = default;

  /// "command", "webhook": names its part of the queue.
  virtual std::string name() const = 0;

  /// Delivers one message (JSON) within the time, and gives up early when asked to stop. Throws
  /// DeliveryError when it was not, or perhaps not, delivered; what else it throws is the message's
  /// fault, as MessageRefused is.
  virtual void deliver(const std::string& message, std::chrono::milliseconds time_out,
                       const std::stop_token& stop) = 0;
};

}  // namespace biotomy::acquisition
