#pragma once

#include <cstddef>
#include <span>

#include "firmware_bridge/wire/unique_fd.hpp"

namespace biotomy::bridge {

/// The server's side of a frame in shared memory: write the pixels in place, then seal it and send
/// the descriptor. Throws std::system_error if the memory is not to be had.
class FrameMemory {
 public:
  explicit FrameMemory(std::size_t size);  ///< in bytes, at least 1
  ~FrameMemory();
  FrameMemory(const FrameMemory&) = delete;
  FrameMemory& operator=(const FrameMemory&) = delete;

  /// Writable until seal().
  std::span<std::byte> bytes() const { return {static_cast<std::byte*>(data_), size_}; }

  /// The memfd, sealed for ever against writing, shrinking and growing. Called once; bytes() is
  /// empty afterwards.
  UniqueFd seal();

 private:
  void unmap();

  std::size_t size_ = 0;
  void* data_ = nullptr;
  UniqueFd descriptor_;
};

/// The client's side: a received descriptor, mapped read-only after it was seen to be a memfd of
/// exactly the size expected and sealed against writing and shrinking. So no later act of the
/// sender can change a pixel or raise SIGBUS. Throws RigSocketError (malformed) otherwise.
class MappedFrame {
 public:
  MappedFrame(const UniqueFd& descriptor, std::size_t expected_size);
  ~MappedFrame();
  MappedFrame(const MappedFrame&) = delete;
  MappedFrame& operator=(const MappedFrame&) = delete;

  std::span<const std::byte> bytes() const { return {static_cast<const std::byte*>(data_), size_}; }

 private:
  std::size_t size_ = 0;
  void* data_ = nullptr;
};

}  // namespace biotomy::bridge
