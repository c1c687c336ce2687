#pragma once

#include <chrono>
#include <filesystem>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>

#include "firmware_bridge/wire/unique_fd.hpp"

namespace biotomy::bridge {

/// What went wrong between two processes of a rig.
class RigSocketError : public std::runtime_error {
 public:
  enum class Kind {
    timeout,       ///< nothing came, or nothing could be sent, in time
    disconnected,  ///< the other side is gone, or was never there
    malformed,     ///< what came is no packet of ours: too long, empty, or with several descriptors
    failed,        ///< the operating system refused, such as for want of descriptors
  };

  RigSocketError(Kind kind, const std::string& message)
      : std::runtime_error(message), kind_(kind) {}
  Kind kind() const { return kind_; }

 private:
  Kind kind_;
};

/// One message: its text and, maybe, an open file.
struct RigPacket {
  std::string text;
  UniqueFd descriptor;
};

inline constexpr std::size_t kMostBytesInAPacket = std::size_t{64} * 1024;

/// One end of a connection over a Unix-domain SOCK_SEQPACKET socket: packets arrive whole, in order
/// and once. Every wait has a limit, interrupted calls are taken up again, and a peer that is gone
/// is an exception, never a signal. One thread sends and receives; shut_down() may be called from
/// any other.
class RigConnection {
 public:
  /// Throws RigSocketError: disconnected if nobody listens there, timeout if nobody takes the call.
  static RigConnection connect(const std::filesystem::path& path,
                               std::chrono::milliseconds time_out);

  /// Takes over a connected SOCK_SEQPACKET socket.
  explicit RigConnection(UniqueFd socket) : socket_(std::move(socket)) {}

  /// Sends one packet, with `descriptor` unless it is -1; the caller keeps its own copy.
  void send(std::string_view text, std::chrono::milliseconds time_out, int descriptor = -1);

  /// The next packet; received descriptors are close-on-exec. A packet that is malformed is
  /// swallowed whole (with its descriptors closed): the connection stays usable.
  RigPacket receive(std::chrono::milliseconds time_out);

  /// Whether receive() would have something to say before `time_out`: a packet, or that the peer
  /// is gone.
  bool wait(std::chrono::milliseconds time_out) const;

  /// Ends the connection for both sides: their pending and later calls throw `disconnected`.
  void shut_down() const;

 private:
  UniqueFd socket_;
};

/// The listening end. It makes the socket's file (mode 0660), replacing one that nobody listens on
/// any more, and removes it when destroyed.
class RigListener {
 public:
  /// Throws RigSocketError if another process listens there, or the path is too long or not
  /// writable.
  explicit RigListener(const std::filesystem::path& path);
  ~RigListener();
  RigListener(const RigListener&) = delete;
  RigListener& operator=(const RigListener&) = delete;

  /// A new connection, or none within `time_out`.
  std::optional<RigConnection> accept(std::chrono::milliseconds time_out);

  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
  UniqueFd socket_;
};

}  // namespace biotomy::bridge
