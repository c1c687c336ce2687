#include "sim/service/rig_server.hpp"

#include <chrono>
#include <future>
#include <list>
#include <optional>
#include <utility>

namespace biotomy::sim {

namespace {

using namespace std::chrono_literals;

constexpr auto kPoll = 50ms;
constexpr auto kSendingTimeOut = 1000ms;
constexpr std::size_t kMostConnections = 16;

bool ready(const std::future<void>& work) {
  return work.wait_for(0s) == std::future_status::ready;
}

}  // namespace

RigServer::RigServer(const std::filesystem::path& socket, Handlers handlers)
    : listener_(socket), handlers_(std::move(handlers)) {}

void RigServer::run(const std::stop_token& stop) {
  std::list<std::future<void>> connections;
  while (!stop.stop_requested()) {
    for (auto work = connections.begin(); work != connections.end();) {
      if (!ready(*work)) {
        ++work;
        continue;
      }
      work->get();  // what a handler could not cope with comes out here
      work = connections.erase(work);
    }
    std::optional<bridge::RigConnection> connection = listener_.accept(kPoll);
    if (connection && connections.size() < kMostConnections) {
      connections.push_back(
          std::async(std::launch::async, [this, stop, taken = std::move(*connection)]() mutable {
            serve(std::move(taken), stop);
          }));
    }
  }
  for (std::future<void>& work : connections) {
    work.get();
  }
}

void RigServer::serve(bridge::RigConnection connection, const std::stop_token& stop) const {
  RigServiceHandler* handler = nullptr;
  const auto device_is_gone = [&] { return handler != nullptr && !handler->present(); };
  while (!stop.stop_requested() && !device_is_gone()) {
    try {
      if (!connection.wait(kPoll)) {
        continue;
      }
      const bridge::RigPacket packet = connection.receive(kSendingTimeOut);
      std::optional<bridge::RigAnswer> answer;
      try {
        const bridge::RigMessage request = bridge::from_json(packet.text);
        answer = handler == nullptr ? answer_first(request, handler) : handler->answer(request);
      } catch (const bridge::MessageError& error) {
        answer = bridge::RigAnswer{bridge::ErrorMessage{error.what()}, {}};
      } catch (const bridge::RigRefusal& refusal) {
        answer = bridge::RigAnswer{bridge::ErrorMessage{refusal.what()}, {}};
      }
      if (answer && !device_is_gone()) {
        connection.send(bridge::to_json(answer->message), kSendingTimeOut,
                        answer->descriptor.get());
      }
    } catch (const bridge::RigSocketError&) {
      return;  // gone, or no longer understandable: the client connects anew
    }
  }
}

std::optional<bridge::RigAnswer> RigServer::answer_first(const bridge::RigMessage& request,
                                                         RigServiceHandler*& handler) const {
  const auto* hello = std::get_if<bridge::HelloMessage>(&request);
  if (hello == nullptr) {
    throw bridge::RigRefusal("a connection begins with hello, not " + bridge::type_of(request));
  }
  if (hello->protocol != bridge::kRigProtocol) {
    throw bridge::RigRefusal("this is protocol " + std::to_string(bridge::kRigProtocol) + ", not " +
                             std::to_string(hello->protocol));
  }
  const auto found = handlers_.find(hello->service);
  if (found == handlers_.end()) {
    throw bridge::RigRefusal("this service is not offered here");
  }
  handler = found->second;
  std::optional<bridge::WelcomeMessage> welcome = handler->welcome();
  if (!welcome) {
    return std::nullopt;
  }
  return bridge::RigAnswer{*std::move(welcome), {}};
}

}  // namespace biotomy::sim
