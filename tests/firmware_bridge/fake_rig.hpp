#pragma once

#include <atomic>
#include <functional>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

#include "firmware_bridge/wire/rig_client.hpp"
#include "tests/temporary_folder.hpp"

namespace biotomy::bridge::testing {

/// A rig's process in a thread: answers hello, and everything else as `answer` says. It notes what
/// it was asked. drop() ends the connection there is, stop() the whole rig.
class FakeRig {
 public:
  using Answer = std::function<RigAnswer(const RigMessage&)>;

  /// `answer` may throw RigRefusal, answered by `error`.
  explicit FakeRig(Answer answer) : answer_(std::move(answer)) { start(); }
  ~FakeRig() { stop(); }

  std::filesystem::path path() const { return folder_ / "rig.sock"; }

  void start() {
    is_stopping_ = false;
    listener_.emplace(path());
    thread_ = std::thread([this] { serve(); });
  }

  void stop() {
    is_stopping_ = true;
    drop();
    if (thread_.joinable()) thread_.join();
    listener_.reset();
  }

  void drop() {
    const std::lock_guard lock(mutex_);
    if (connection_) connection_->shut_down();
  }

  std::vector<RigMessage> asked() {
    const std::lock_guard lock(mutex_);
    return asked_;
  }

  std::atomic<bool> is_silent = false;
  WelcomeMessage welcome{.camera = WelcomeMessage::Camera{"fake", 4, 2}};

 private:
  void serve() {
    while (!is_stopping_) {
      std::optional<RigConnection> accepted = listener_->accept(std::chrono::milliseconds(10));
      if (!accepted) continue;
      {
        const std::lock_guard lock(mutex_);
        connection_.emplace(std::move(*accepted));
      }
      try {
        while (!is_stopping_) answer_one();
      } catch (const RigSocketError&) {
      }
      const std::lock_guard lock(mutex_);
      connection_.reset();
    }
  }

  void answer_one() {
    constexpr auto kLimit = std::chrono::seconds(5);
    if (!connection_->wait(std::chrono::milliseconds(10))) return;
    const RigMessage request = from_json(connection_->receive(kLimit).text);
    {
      const std::lock_guard lock(mutex_);
      asked_.push_back(request);
    }
    if (is_silent) return;
    RigAnswer answer;
    try {
      if (std::holds_alternative<HelloMessage>(request)) {
        answer.message = welcome;
      } else {
        answer = answer_(request);
      }
    } catch (const RigRefusal& refusal) {
      answer.message = ErrorMessage{refusal.what()};
    }
    connection_->send(to_json(answer.message), kLimit, answer.descriptor.get());
  }

  tests::TemporaryFolder folder_;
  Answer answer_;
  std::optional<RigListener> listener_;
  std::mutex mutex_;
  std::optional<RigConnection> connection_;
  std::vector<RigMessage> asked_;
  std::atomic<bool> is_stopping_ = false;
  std::thread thread_;
};

}  // namespace biotomy::bridge::testing
