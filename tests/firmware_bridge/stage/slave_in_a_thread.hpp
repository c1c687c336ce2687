#pragma once

#include <atomic>
#include <string>
#include <thread>

#include <arpa/inet.h>
#include <modbus/modbus.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

namespace biotomy::bridge::testing {

/// A Modbus TCP slave of libmodbus on a free port of the loopback, one master at a time. Knobs make
/// it silent, busy, or make it hang up instead of answering.
class SlaveInAThread {
 public:
  SlaveInAThread() : mapping_(modbus_mapping_new(0, 0, 16, 16)) {
    listener_ = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t length = sizeof address;
    if (::bind(listener_, reinterpret_cast<sockaddr*>(&address), length) != 0 ||
        ::listen(listener_, 8) != 0 ||
        ::getsockname(listener_, reinterpret_cast<sockaddr*>(&address), &length) != 0) {
      std::abort();
    }
    port_ = ntohs(address.sin_port);
    context_ = modbus_new_tcp("127.0.0.1", port_);
    thread_ = std::thread([this] { serve(); });
  }
  ~SlaveInAThread() {
    stop();
    modbus_free(context_);
    modbus_mapping_free(mapping_);
  }
  SlaveInAThread(const SlaveInAThread&) = delete;
  SlaveInAThread& operator=(const SlaveInAThread&) = delete;

  std::string endpoint() const { return "tcp://127.0.0.1:" + std::to_string(port_); }
  modbus_mapping_t& registers() { return *mapping_; }

  void stop() {
    is_stopping_ = true;
    if (thread_.joinable()) thread_.join();
    if (listener_ >= 0) ::close(listener_);
    listener_ = -1;
  }

  std::atomic<int> requests = 0;
  std::atomic<int> connections = 0;
  std::atomic<int> silent_requests = 0;  ///< so many are left unanswered
  std::atomic<bool> hangs_up = false;
  std::atomic<bool> is_busy = false;

 private:
  bool readable(int descriptor) const {
    pollfd waited{descriptor, POLLIN, 0};
    return ::poll(&waited, 1, 10) > 0;
  }

  void serve() {
    while (!is_stopping_) {
      if (!readable(listener_)) continue;
      const int master = ::accept4(listener_, nullptr, nullptr, SOCK_CLOEXEC);
      if (master < 0) continue;
      ++connections;
      modbus_set_socket(context_, master);
      while (!is_stopping_ && answer_one(master)) {
      }
      ::close(master);
    }
  }

  bool answer_one(int master) {
    if (!readable(master)) return true;
    uint8_t query[MODBUS_TCP_MAX_ADU_LENGTH];
    const int length = modbus_receive(context_, query);
    if (length < 0) return false;
    ++requests;
    if (hangs_up) return false;
    if (silent_requests > 0) {
      --silent_requests;
      return true;
    }
    if (is_busy) {
      modbus_reply_exception(context_, query, MODBUS_EXCEPTION_SLAVE_OR_SERVER_BUSY);
      return true;
    }
    modbus_reply(context_, query, length, mapping_);
    return true;
  }

  modbus_mapping_t* mapping_;
  modbus_t* context_ = nullptr;
  int listener_ = -1;
  int port_ = 0;
  std::atomic<bool> is_stopping_ = false;
  std::thread thread_;
};

}  // namespace biotomy::bridge::testing
