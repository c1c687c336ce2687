#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <stop_token>

#include "firmware_bridge/wire/rig_client.hpp"
#include "firmware_bridge/wire/rig_messages.hpp"
#include "firmware_bridge/wire/rig_socket.hpp"

namespace biotomy::sim {

/// One service of the rig socket. Called from the threads of several connections at once.
class RigServiceHandler {
 public:
  virtual ~RigServiceHandler() = default;

  /// The answer to `hello`; none: nothing is answered.
  virtual std::optional<bridge::WelcomeMessage> welcome() = 0;

  /// The answer to a request; none: nothing is answered, now or later. Throws bridge::RigRefusal
  /// for what it will not do.
  virtual std::optional<bridge::RigAnswer> answer(const bridge::RigMessage& request) = 0;

  /// Whether the device is there: while it is not, its connections are closed.
  virtual bool present() const { return true; }
};

/// Serves camera, lines and bench on one Unix-domain socket, a thread a connection. Whatever is
/// wrong with a request is answered by `error`, and the connection stays; packets that are none end
/// it.
class RigServer {
 public:
  using Handlers = std::map<bridge::RigService, RigServiceHandler*>;

  /// Listens at once. Throws bridge::RigSocketError if it can't.
  RigServer(const std::filesystem::path& socket, Handlers handlers);

  /// Serves until stopped; ends within a tenth of a second then, but not before the frame that is
  /// being taken. A handler's own failure (not a refusal) ends it by that exception.
  void run(const std::stop_token& stop);

 private:
  void serve(bridge::RigConnection connection, const std::stop_token& stop) const;
  std::optional<bridge::RigAnswer> answer_first(const bridge::RigMessage& request,
                                                RigServiceHandler*& handler) const;

  bridge::RigListener listener_;
  Handlers handlers_;
};

}  // namespace biotomy::sim
