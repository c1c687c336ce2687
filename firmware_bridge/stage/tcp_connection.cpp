#include "firmware_bridge/stage/tcp_connection.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <memory>
#include <system_error>

#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>

#include "firmware_bridge/device_error.hpp"
#include "firmware_bridge/wire/configuration_error.hpp"

namespace biotomy::bridge {

namespace {

using Clock = std::chrono::steady_clock;

struct AddressListDeleter {
  void operator()(addrinfo* list) const { freeaddrinfo(list); }
};

/// Waits until the socket is connected; the error, 0 if there is none.
int await_connection(int socket, Clock::time_point until) {
  for (;;) {
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(until - Clock::now());
    pollfd waited{socket, POLLOUT, 0};
    const int ready = ::poll(&waited, 1, static_cast<int>(std::max<long long>(0, left.count())));
    if (ready == 0) return ETIMEDOUT;
    if (ready > 0) break;
    if (errno != EINTR) return errno;
  }
  int error = 0;
  socklen_t length = sizeof error;
  return getsockopt(socket, SOL_SOCKET, SO_ERROR, &error, &length) == 0 ? error : errno;
}

/// A name that is wrong stays wrong; after a power cut a name server may be later than we are.
[[noreturn]] void refuse(const std::string& host, int error) {
  const std::string what = "host " + host + ": " + gai_strerror(error);
  if (error == EAI_NONAME || error == EAI_NODATA) {
    throw ConfigurationError(what + "; write its address, or mend the name");
  }
  throw DeviceError(DeviceError::Kind::disconnected,
                    what +
                        "; is the network up, and does the name server answer? With an address "
                        "in place of the name none is needed");
}

}  // namespace

TcpAddresses::TcpAddresses(const std::string& host, std::uint16_t port, Lookup look_up) {
  addrinfo wanted{};
  wanted.ai_family = AF_UNSPEC;
  wanted.ai_socktype = SOCK_STREAM;
  addrinfo* found = nullptr;
  const int error = look_up(host.c_str(), std::to_string(port).c_str(), &wanted, &found);
  const std::unique_ptr<addrinfo, AddressListDeleter> list(found);
  if (error != 0) refuse(host, error);
  for (const addrinfo* one = found; one != nullptr; one = one->ai_next) {
    Address& address = addresses_.emplace_back();
    address.length = one->ai_addrlen;
    std::memcpy(&address.bytes, one->ai_addr, one->ai_addrlen);
  }
}

UniqueFd TcpAddresses::connect(std::chrono::milliseconds time_out) const {
  const Clock::time_point until = Clock::now() + time_out;
  int error = ETIMEDOUT;
  for (const Address& address : addresses_) {
    UniqueFd socket(
        ::socket(address.bytes.ss_family, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, IPPROTO_TCP));
    if (!socket.valid()) {
      error = errno;
      continue;
    }
    const auto* to = reinterpret_cast<const sockaddr*>(&address.bytes);
    error = ::connect(socket.get(), to, address.length) == 0 ? 0 : errno;
    if (error == EINPROGRESS) error = await_connection(socket.get(), until);
    if (error == 0) {
      // A request is one small segment: it must not wait for a second.
      const int on = 1;
      setsockopt(socket.get(), IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
      return socket;
    }
  }
  throw std::system_error(error, std::generic_category());
}

}  // namespace biotomy::bridge
