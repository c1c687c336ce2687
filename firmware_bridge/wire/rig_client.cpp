#include "firmware_bridge/wire/rig_client.hpp"

#include <algorithm>
#include <utility>

namespace biotomy::bridge {

namespace {

std::chrono::milliseconds left_until(std::chrono::steady_clock::time_point deadline) {
  const auto left = deadline - std::chrono::steady_clock::now();
  return std::max(std::chrono::milliseconds(0), std::chrono::ceil<std::chrono::milliseconds>(left));
}

}  // namespace

RigClient::RigClient(std::filesystem::path path, RigService service)
    : path_(std::move(path)), service_(service) {}

std::uint64_t RigClient::connect(std::chrono::milliseconds time_out) {
  if (connection_) return connections_;
  const Deadline deadline = std::chrono::steady_clock::now() + time_out;
  connection_ = RigConnection::connect(path_, time_out);
  try {
    RigAnswer answer =
        exchange(HelloMessage{.protocol = kRigProtocol, .service = service_}, deadline);
    const auto* welcome = std::get_if<WelcomeMessage>(&answer.message);
    if (welcome == nullptr) {
      throw MessageError("rig socket " + path_.string() + ": hello was answered by " +
                         type_of(answer.message));
    }
    if (welcome->protocol != kRigProtocol) {
      throw MessageError("rig socket " + path_.string() + ": it speaks protocol " +
                         std::to_string(welcome->protocol) + ", this program " +
                         std::to_string(kRigProtocol) + "; install matching versions");
    }
    if (service_ == RigService::camera && !welcome->camera) {
      throw MessageError("rig socket " + path_.string() + ": the camera did not say what it is");
    }
    welcome_ = *welcome;
  } catch (...) {
    connection_.reset();
    throw;
  }
  return ++connections_;
}

RigAnswer RigClient::ask(const RigMessage& request, std::chrono::milliseconds time_out) {
  const Deadline deadline = std::chrono::steady_clock::now() + time_out;
  connect(time_out);
  try {
    return exchange(request, deadline);
  } catch (const RigRefusal&) {
    throw;
  } catch (...) {
    connection_.reset();
    throw;
  }
}

RigAnswer RigClient::exchange(const RigMessage& request, Deadline deadline) {
  connection_->send(to_json(request), left_until(deadline));
  RigPacket packet = connection_->receive(left_until(deadline));
  RigAnswer answer{.message = from_json(packet.text), .descriptor = std::move(packet.descriptor)};
  if (const auto* error = std::get_if<ErrorMessage>(&answer.message)) {
    throw RigRefusal(error->message);
  }
  return answer;
}

}  // namespace biotomy::bridge
