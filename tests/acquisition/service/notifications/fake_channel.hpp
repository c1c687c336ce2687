#pragma once

#include <condition_variable>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "acquisition/service/notifications/channel.hpp"

namespace biotomy::tests {

/// What was asked of a fake channel; outlives it.
struct ChannelLog {
  std::mutex mutex;
  std::condition_variable changed;
  int failures_to_come = 0;  ///< so many attempts fail first
  bool hangs = false;        ///< each attempt lasts until it is told to stop
  std::string refused;       ///< this message is never taken
  int attempts = 0;
  std::vector<std::string> delivered;

  /// Waits until so many were delivered.
  bool await_delivered(std::size_t count) {
    std::unique_lock lock(mutex);
    return changed.wait_for(lock, std::chrono::seconds(60),
                            [&] { return delivered.size() >= count; });
  }
  bool await_attempts(int count) {
    std::unique_lock lock(mutex);
    return changed.wait_for(lock, std::chrono::seconds(60), [&] { return attempts >= count; });
  }
};

class FakeChannel final : public acquisition::Channel {
 public:
  explicit FakeChannel(std::shared_ptr<ChannelLog> log) : log_(std::move(log)) {}

  std::string name() const override { return "fake"; }

  void deliver(const std::string& message, std::chrono::milliseconds,
               const std::stop_token& stop) override {
    std::unique_lock lock(log_->mutex);
    ++log_->attempts;
    log_->changed.notify_all();
    if (log_->hangs) {
      std::condition_variable_any stopped;
      stopped.wait(lock, stop, [] { return false; });
      throw acquisition::DeliveryError("stopped");
    }
    if (message == log_->refused) throw acquisition::MessageRefused("that is no message");
    if (log_->failures_to_come > 0) {
      --log_->failures_to_come;
      throw acquisition::DeliveryError("nobody is at home");
    }
    log_->delivered.push_back(message);
    log_->changed.notify_all();
  }

 private:
  std::shared_ptr<ChannelLog> log_;
};

}  // namespace biotomy::tests
