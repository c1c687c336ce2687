#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <linux/usb/ch9.h>

#include "firmware_bridge/wire/unique_fd.hpp"

namespace biotomy::tests {

/// A USB device that is this process, plugged into the kernel's port without wires (dummy_hcd)
/// while the object lives. Every call but write() throws std::system_error.
class RawGadget {
 public:
  /// Plugs it in, at high speed.
  RawGadget();

  /// Waits for the next request on endpoint 0. It must be answered by exactly one of answer(),
  /// take() and stall().
  usb_ctrlrequest next_request();

  /// Of a request that asks: at most as much of `data` as it asks for.
  void answer(const usb_ctrlrequest& request, std::span<const std::uint8_t> data);

  /// Of a request that tells: what it tells, maybe nothing. The host goes on when this returns.
  std::vector<std::uint8_t> take(const usb_ctrlrequest& request);

  /// Of any: no.
  void stall();

  /// The host has chosen the configuration: turns its endpoint on, and returns the endpoint's
  /// handle. To be called once, before the request is taken.
  int enable(const usb_endpoint_descriptor& endpoint);
  void set_configured();

  static constexpr std::size_t kMostBytesInAWrite = 4096;

  /// Waits until the host has fetched all of `data`, at most kMostBytesInAWrite. False if it did
  /// not: a signal came to this thread, or the host gave the endpoint up.
  bool write(int endpoint, std::span<const std::uint8_t> data) const;

 private:
  bridge::UniqueFd device_;
};

}  // namespace biotomy::tests
