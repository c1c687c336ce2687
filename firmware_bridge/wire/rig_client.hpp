#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <stdexcept>
#include <string>

#include "firmware_bridge/wire/rig_messages.hpp"
#include "firmware_bridge/wire/rig_socket.hpp"

namespace biotomy::bridge {

/// An answer of a rig's process: the message and, with a frame, its descriptor.
struct RigAnswer {
  RigMessage message;
  UniqueFd descriptor{};
};

/// The other side answered `error`: the message is its sentence. The connection is still good.
class RigRefusal : public std::runtime_error {
 public:
  explicit RigRefusal(const std::string& message) : std::runtime_error(message) {}
};

/// The asking side of one service: connects and says hello when it has to, asks, takes the answer.
/// After anything but a refusal went wrong the connection is closed, since a late answer would be
/// taken for the next one's; the next call opens another.
/// Throws RigSocketError, MessageError and RigRefusal.
class RigClient {
 public:
  RigClient(std::filesystem::path path, RigService service);

  /// Connects if need be. Counts up with each new connection, from 1.
  std::uint64_t connect(std::chrono::milliseconds time_out);

  /// Connects if need be, sends `request` and gives the answer to it; all within `time_out`.
  RigAnswer ask(const RigMessage& request, std::chrono::milliseconds time_out);

  /// Closes the connection; the next call opens another.
  void disconnect() { connection_.reset(); }

  bool connected() const { return connection_.has_value(); }

  /// What the server said of itself at the last connect.
  const WelcomeMessage& welcome() const { return welcome_; }

  const std::filesystem::path& path() const { return path_; }

 private:
  using Deadline = std::chrono::steady_clock::time_point;
  RigAnswer exchange(const RigMessage& request, Deadline deadline);

  std::filesystem::path path_;
  RigService service_;
  std::optional<RigConnection> connection_;
  WelcomeMessage welcome_;
  std::uint64_t connections_ = 0;
};

}  // namespace biotomy::bridge
