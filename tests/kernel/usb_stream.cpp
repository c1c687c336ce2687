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
  halt();
  {
    const std::lock_guard lock(mutex_);
    is_over_ = true;
    changed_.notify_all();
  }
  thread_.join();
}

void UsbStream::halt() {
  std::unique_lock lock(mutex_);
  order_.reset();
  must_halt_ = true;
  while (is_at_work_) {
    pthread_kill(thread_.native_handle(), kBreakOff);
    changed_.wait_for(lock, kBreakOffAgain);
  }
  must_halt_ = false;
}

void UsbStream::start(int endpoint, const FrameSize& size) {
  halt();
  const std::lock_guard lock(mutex_);
  order_ = Order{endpoint, size};
  changed_.notify_all();
}

void UsbStream::run() {
  std::unique_lock lock(mutex_);
  for (;;) {
    changed_.wait(lock, [this] { return is_over_ || order_; });
    if (is_over_) return;
    const Order order = *order_;
    order_.reset();
    is_at_work_ = true;
    lock.unlock();
    stream(order);
    lock.lock();
    is_at_work_ = false;
    changed_.notify_all();
  }
}

void UsbStream::stream(const Order& order) {
  Clock::time_point next = Clock::now();
  while (!must_halt_) {
    try {
      if (!send_frame(order.endpoint, source_.next(order.size))) continue;
    } catch (const std::exception& error) {
      std::cerr << "usb_camera: no frame: " << error.what() << std::endl;
      std::this_thread::sleep_for(kSourceIsAway);
    }
    next = std::max(next + interval_, Clock::now());
    std::this_thread::sleep_until(next);
  }
}

bool UsbStream::send_frame(int endpoint, std::span<const std::uint8_t> jpeg) {
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
  for (std::size_t sent = 0; sent < payload.size(); sent += RawGadget::kMostBytesInAWrite) {
    const std::size_t length = std::min(RawGadget::kMostBytesInAWrite, payload.size() - sent);
    if (must_halt_ || !gadget_.write(endpoint, std::span(payload).subspan(sent, length))) {
      return false;
    }
  }
  return true;
}

}  // namespace biotomy::tests
