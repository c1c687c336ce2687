#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <span>
#include <thread>

#include "tests/kernel/frame_source.hpp"
#include "tests/kernel/raw_gadget.hpp"

namespace biotomy::tests {

/// The frames that a USB camera sends, in a thread of its own: from when the host has chosen a
/// size until it chooses anew. A host that has stopped fetches nothing, and the thread waits.
class UsbStream {
 public:
  UsbStream(const RawGadget& gadget, FrameSource& source, int frames_per_second);
  ~UsbStream();

  /// Sends frames of this size through the endpoint, beginning with one that is yet to be taken.
  /// Nothing of an earlier frame is sent once this has returned.
  void start(int endpoint, const FrameSize& size);

 private:
  struct Order {
    int endpoint = -1;
    FrameSize size;
  };

  void run();
  void stream(const Order& order, int number);
  void send_frame(int endpoint, std::span<const std::uint8_t> jpeg, int number);
  void break_off(std::unique_lock<std::mutex>& lock);

  const RawGadget& gadget_;
  FrameSource& source_;
  const std::chrono::nanoseconds interval_;
  bool odd_frame_ = false;

  std::mutex mutex_;
  std::condition_variable changed_;
  Order order_;
  int orders_ = 0;  ///< the number of the one that is in force
  bool is_writing_ = false;
  bool is_over_ = false;
  std::thread thread_;
};

}  // namespace biotomy::tests
