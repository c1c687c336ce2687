#pragma once

#include <condition_variable>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include <httplib.h>
#include <nlohmann/json.hpp>

namespace biotomy::tests {

/// A web server on this computer that takes messages by POST, at any path. It can refuse them.
class HookServer {
 public:
  HookServer() {
    server_.Post(".*", [this](const httplib::Request& request, httplib::Response& response) {
      const std::scoped_lock lock(mutex_);
      ++attempts_;
      changed_.notify_all();
      response.status = refuses_ ? 503 : 204;
      if (!refuses_) messages_.push_back(nlohmann::json::parse(request.body));
    });
    port_ = server_.bind_to_any_port("127.0.0.1");
    thread_ = std::thread([this] { server_.listen_after_bind(); });
    while (!server_.is_running()) std::this_thread::yield();
  }
  ~HookServer() {
    server_.stop();
    thread_.join();
  }
  HookServer(const HookServer&) = delete;
  HookServer& operator=(const HookServer&) = delete;

  std::string url() const { return "http://127.0.0.1:" + std::to_string(port_) + "/hook"; }

  void refuse(bool on) {
    const std::scoped_lock lock(mutex_);
    refuses_ = on;
  }

  bool await_attempts(int count) {
    std::unique_lock lock(mutex_);
    return changed_.wait_for(lock, std::chrono::seconds(60), [&] { return attempts_ >= count; });
  }

  /// Waits until a message of the kind has arrived, and gives it; null when none does.
  nlohmann::json await_message(const std::string& kind, bool over = false) {
    std::unique_lock lock(mutex_);
    nlohmann::json found;
    changed_.wait_for(lock, std::chrono::seconds(60), [&] {
      for (const nlohmann::json& message : messages_) {
        if (message.at("kind") == kind && message.at("over") == over) found = message;
      }
      return !found.is_null();
    });
    return found;
  }

  std::vector<nlohmann::json> messages() {
    const std::scoped_lock lock(mutex_);
    return messages_;
  }

 private:
  httplib::Server server_;
  int port_ = 0;
  std::thread thread_;
  std::mutex mutex_;
  std::condition_variable changed_;
  bool refuses_ = false;
  int attempts_ = 0;
  std::vector<nlohmann::json> messages_;
};

}  // namespace biotomy::tests
