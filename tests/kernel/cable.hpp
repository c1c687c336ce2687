#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

#include "firmware_bridge/wire/unique_fd.hpp"

namespace biotomy::tests {

/// What goes over a cable: a packet of the rig's socket, and the name of a file with the content of
/// the one that came with it, if one did. A packet without text means: begin anew.
struct CablePacket {
  std::string text;
  std::string file;
};

/// One end of a serial line between two computers that carries packets whole and in order. It loses
/// and garbles nothing, unlike a real one. Throws std::system_error.
class Cable {
 public:
  /// A terminal, such as /dev/ttyS1.
  static Cable at(const std::filesystem::path& terminal);

  /// Makes a pseudo-terminal; the other end is to be opened at far_end().
  static Cable make();

  const std::filesystem::path& far_end() const { return far_end_; }

  void send(const CablePacket& packet) const;

  /// Waits for the next, for ever.
  CablePacket receive() const;

 private:
  explicit Cable(bridge::UniqueFd terminal) : terminal_(std::move(terminal)) {}
  void send_bytes(const void* data, std::size_t size) const;
  void receive_bytes(void* data, std::size_t size) const;

  bridge::UniqueFd terminal_;
  bridge::UniqueFd kept_open_;  ///< the far end, so that a computer may come and go there
  std::filesystem::path far_end_;
};

}  // namespace biotomy::tests
