#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <string>
#include <thread>
#include <vector>

#include <poll.h>
#include <unistd.h>

#include "sim/control/pseudo_terminal.hpp"
#include "sim/control/rtu_frame.hpp"
#include "tests/temporary_folder.hpp"

namespace biotomy::bridge::testing {

/// A Modbus RTU slave of sixteen input and sixteen holding registers, unit 1, on a pseudo-terminal.
/// Knobs spoil its answers; each counts down by one with every answer that it spoils. pull_out()
/// takes the whole device away, put_back() makes a new one at the same path.
class SerialSlaveInAThread {
 public:
  SerialSlaveInAThread() { put_back(); }
  ~SerialSlaveInAThread() { pull_out(); }
  SerialSlaveInAThread(const SerialSlaveInAThread&) = delete;
  SerialSlaveInAThread& operator=(const SerialSlaveInAThread&) = delete;

  std::string endpoint() const { return "rtu://" + path().string(); }
  std::filesystem::path path() const { return folder_ / "line"; }

  void pull_out() {
    is_stopping_ = true;
    if (thread_.joinable()) thread_.join();
    terminal_.reset();
  }
  void put_back() {
    terminal_ = std::make_unique<sim::PseudoTerminal>(path());
    is_stopping_ = false;
    thread_ = std::thread([this] { serve(); });
  }

  std::array<std::atomic<std::uint16_t>, 16> input{};
  std::array<std::atomic<std::uint16_t>, 16> holding{};
  std::atomic<int> requests = 0;
  std::atomic<int> writes_of_register_5 = 0;
  std::atomic<int> silent_answers = 0;     ///< not given
  std::atomic<int> damaged_answers = 0;    ///< a bit of them is turned over
  std::atomic<int> doubled_answers = 0;    ///< given twice
  std::atomic<int> withheld_answers = 0;   ///< given before the next answer
  std::atomic<int> exception_answers = 0;  ///< "illegal data address" instead
  /// A register that takes writes and keeps what it has; none below 0.
  std::atomic<int> constant_register = -1;

 private:
  using Bytes = std::vector<std::uint8_t>;

  static bool spoils(std::atomic<int>& knob) {
    if (knob <= 0) return false;
    --knob;
    return true;
  }

  void serve() {
    Bytes received;
    while (!is_stopping_) {
      pollfd waited{terminal_->descriptor(), POLLIN, 0};
      if (::poll(&waited, 1, 5) <= 0) continue;
      std::array<std::uint8_t, 256> chunk{};
      const ssize_t count = ::read(terminal_->descriptor(), chunk.data(), chunk.size());
      if (count <= 0) continue;
      received.insert(received.end(), chunk.begin(), chunk.begin() + count);
      const std::size_t length = sim::rtu_request_length(received);
      if (length == 0 || received.size() < length) continue;
      ++requests;
      send(answer(received));
      received.clear();
    }
  }

  static std::size_t word(const Bytes& bytes, std::size_t at) {
    return static_cast<std::size_t>(bytes[at] << 8 | bytes[at + 1]);
  }

  Bytes answer(const Bytes& request) {
    if (spoils(exception_answers)) {
      return {request[0], static_cast<std::uint8_t>(request[1] | 0x80U), 2};
    }
    const std::size_t address = word(request, 2);
    const std::size_t count = word(request, 4);
    Bytes answer(request.begin(), request.begin() + 2);
    if (request[1] == 16) {
      answer.assign(request.begin(), request.begin() + 6);
      for (std::size_t i = 0; i < count; ++i) {
        const auto value = static_cast<std::uint16_t>(word(request, 7 + 2 * i));
        if (static_cast<int>(address + i) != constant_register) holding.at(address + i) = value;
        if (address + i == 5) ++writes_of_register_5;
      }
      return answer;
    }
    answer.push_back(static_cast<std::uint8_t>(2 * count));
    for (std::size_t i = 0; i < count; ++i) {
      const std::uint16_t value = (request[1] == 4 ? input : holding).at(address + i);
      answer.push_back(static_cast<std::uint8_t>(value >> 8U));
      answer.push_back(static_cast<std::uint8_t>(value & 0xFFU));
    }
    return answer;
  }

  void send(Bytes bytes) {
    const std::uint16_t check = sim::rtu_check(bytes);
    bytes.push_back(static_cast<std::uint8_t>(check & 0xFFU));
    bytes.push_back(static_cast<std::uint8_t>(check >> 8U));
    if (spoils(silent_answers)) return;
    if (spoils(withheld_answers)) {
      withheld_ = bytes;
      return;
    }
    if (spoils(damaged_answers)) bytes[2] ^= 0x10U;
    // All in one, so that nothing depends on when this thread gets to write the rest.
    Bytes all = spoils(doubled_answers) ? bytes : Bytes();
    all.insert(all.end(), withheld_.begin(), withheld_.end());
    withheld_.clear();
    all.insert(all.end(), bytes.begin(), bytes.end());
    put(all);
  }

  void put(const Bytes& bytes) {
    [[maybe_unused]] const ssize_t written =
        ::write(terminal_->descriptor(), bytes.data(), bytes.size());
  }

  tests::TemporaryFolder folder_;
  std::unique_ptr<sim::PseudoTerminal> terminal_;
  std::atomic<bool> is_stopping_ = false;
  Bytes withheld_;
  std::thread thread_;
};

}  // namespace biotomy::bridge::testing
