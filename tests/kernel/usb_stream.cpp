#include "tests/kernel/usb_stream.hpp"

#include <algorithm>
#include <chrono>
#include <csignal>
#include <exception>
#include <iostream>
#include <vector>

#include <pthread.h>

#include "tests/kernel/usb_bytes.hpp"

namespace biotomy::tests {

namespace {

using Clock = std::chrono::steady_clock;
using std::chrono::milliseconds;

/// Breaks off a write that the host does not fetch. It may come just before the write begins, so it
/// is sent until the thread has seen it.
constexpr int kBreakOff = SIGUSR1;
constexpr milliseconds kBreakOffAgain(5);

constexpr milliseconds kSourceIsAway(50);

// Of a payload's header: its end, its clock, the end of a frame.
constexpr unsigned kHeaderEnds = 0x80;
constexpr unsigned kHasTimes = 0x0c;
constexpr unsigned kFrameEnds = 0x02;

constexpr std::size_t kBulkPacket = 512;

}  // namespace

UsbStream::UsbStream(const RawGadget& gadget, FrameSource& source, int frames_per_second)
    : gadget_(gadget),
      source_(source),
      interval_(std::chrono::nanoseconds(std::chrono::seconds(1)) / frames_per_second) {
  struct sigaction action {};
  action.sa_handler = [](int) {};
  sigaction(kBreakOff, &action, nullptr);
  thread_ = std::thread([this] { run(); });
}

UsbStream::~UsbStream() {
  {
    std::unique_lock lock(mutex_);
    is_over_ = true;
    break_off(lock);
  }
  thread_.join();
}

void UsbStream::start(int endpoint, const FrameSize& size) {
  std::unique_lock lock(mutex_);
  order_ = Order{endpoint, size};
  break_off(lock);
}

/// What is under way is no longer wanted. A write ends before this returns; a frame that is yet to
/// come from the source will not be sent.
void UsbStream::break_off(std::unique_lock<std::mutex>& lock) {
  ++orders_;
  changed_.notify_all();
  while (is_writing_) {
    pthread_kill(thread_.native_handle(), kBreakOff);
    changed_.wait_for(lock, kBreakOffAgain);
  }
}

void UsbStream::run() {
  std::unique_lock lock(mutex_);
  for (int begun = 0; !is_over_;) {
    changed_.wait(lock, [&] { return is_over_ || orders_ != begun; });
    begun = orders_;
    const Order order = order_;
    const bool is_wanted = !is_over_;
    lock.unlock();
    if (is_wanted) stream(order, begun);
    lock.lock();
  }
}

void UsbStream::stream(const Order& order, int number) {
  Clock::time_point next = Clock::now();
  const auto is_in_force = [&] {
    const std::lock_guard lock(mutex_);
    return orders_ == number;
  };
  while (is_in_force()) {
    try {
      send_frame(order.endpoint, source_.next(order.size), number);
    } catch (const std::exception& error) {
      std::cerr << "usb_camera: no frame: " << error.what() << std::endl;
      std::this_thread::sleep_for(kSourceIsAway);
    }
    next = std::max(next + interval_, Clock::now());
    std::this_thread::sleep_until(next);
  }
}

/// As much of it as the order stays in force.
void UsbStream::send_frame(int endpoint, std::span<const std::uint8_t> jpeg, int number) {
  const auto ticks = static_cast<std::uint32_t>(
      std::chrono::duration_cast<std::chrono::microseconds>(Clock::now().time_since_epoch())
          .count() *
      (kClockHz / 1'000'000));
  UsbBytes header;
  header.u8({kPayloadHeaderBytes, kHeaderEnds | kHasTimes | kFrameEnds | (odd_frame_ ? 1U : 0U)});
  header.u32(ticks).u32(ticks).u16(0);
  odd_frame_ = !odd_frame_;

  std::vector<std::uint8_t> payload = header.get();
  payload.insert(payload.end(), jpeg.begin(), jpeg.end());
  // A transfer ends with a packet that is not full; a JPEG reader takes no note of bytes behind it.
  if (payload.size() % kBulkPacket == 0) payload.push_back(0);
  std::unique_lock lock(mutex_);
  for (std::size_t sent = 0; sent < payload.size() && orders_ == number;) {
    const std::size_t length = std::min(RawGadget::kMostBytesInAWrite, payload.size() - sent);
    is_writing_ = true;
    lock.unlock();
    const bool is_fetched = gadget_.write(endpoint, std::span(payload).subspan(sent, length));
    lock.lock();
    is_writing_ = false;
    changed_.notify_all();
    if (!is_fetched) return;
    sent += length;
  }
}

}  // namespace biotomy::tests
