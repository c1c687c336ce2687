#include "tests/faults/status_watch.hpp"

#include <chrono>
#include <stdexcept>
#include <thread>

#include <httplib.h>

namespace biotomy::tests {

namespace {

constexpr std::chrono::seconds kPatience(60);
constexpr std::chrono::milliseconds kInterval(1);

}  // namespace

StatusWatch::StatusWatch(const std::string& url) : client_(std::make_unique<httplib::Client>(url)) {
  client_->set_keep_alive(true);
  client_->set_tcp_nodelay(true);
}

StatusWatch::~StatusWatch() = default;

nlohmann::json StatusWatch::look() {
  const httplib::Result answer = client_->Get("/api/v1/status");
  if (!answer || answer->status != 200) throw std::runtime_error("the daemon gives no status");
  return nlohmann::json::parse(answer->body);
}

nlohmann::json StatusWatch::await(const std::function<bool(const nlohmann::json&)>& holds) {
  const auto deadline = std::chrono::steady_clock::now() + kPatience;
  for (;;) {
    nlohmann::json status = look();
    if (holds(status)) return status;
    if (status.at("state") == "done" || std::chrono::steady_clock::now() > deadline) {
      throw std::runtime_error("it did not come to this: " + status.dump(1));
    }
    std::this_thread::sleep_for(kInterval);
  }
}

nlohmann::json StatusWatch::await_state(const std::string& state) {
  return await([&](const nlohmann::json& status) { return status.at("state") == state; });
}

nlohmann::json StatusWatch::await_committed(std::int64_t layers) {
  return await([&](const nlohmann::json& status) { return status.at("committed") >= layers; });
}

nlohmann::json StatusWatch::await_stop() {
  return await([](const nlohmann::json& status) {
    const std::string state = status.at("state");
    return state == "faulted" || state == "paused" || state == "held";
  });
}

std::string told(const nlohmann::json& status) {
  if (status.at("alarm").is_object()) return status.at("alarm").at("cause");
  if (status.at("state") == "held") return status.at("waiting_for");
  return status.at("pause_cause");
}

}  // namespace biotomy::tests
