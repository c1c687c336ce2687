#include "sim/control/modbus_tcp_server.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <stdexcept>
#include <vector>

#include <modbus/modbus.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/time.h>

#include "firmware_bridge/wire/unique_fd.hpp"

namespace biotomy::sim {

namespace {

// The MBAP header: transaction (2), protocol (2, always 0), length of what follows (2), unit (1).
constexpr std::size_t kHeader = 7;
constexpr std::size_t kMostFrame = MODBUS_TCP_MAX_ADU_LENGTH;
constexpr std::size_t kMostClients = 16;
constexpr int kPollMilliseconds = 50;
constexpr int kBacklog = 8;

struct ContextDeleter {
  void operator()(modbus_t* context) const { modbus_free(context); }
};

std::uint16_t word_at(std::span<const std::uint8_t> bytes, std::size_t at) {
  return static_cast<std::uint16_t>((bytes[at] << 8) | bytes[at + 1]);
}

int port_of(int socket) {
  sockaddr_storage address{};
  socklen_t size = sizeof(address);
  if (getsockname(socket, reinterpret_cast<sockaddr*>(&address), &size) != 0) {
    return 0;
  }
  return ntohs(address.ss_family == AF_INET6
                   ? reinterpret_cast<const sockaddr_in6*>(&address)->sin6_port
                   : reinterpret_cast<const sockaddr_in*>(&address)->sin_port);
}

/// Garbage came, or the master takes no answers: its connection ends, and no other.
struct ClientLost {};

/// A master's connection and what has come of its next request.
struct Client {
  bridge::UniqueFd socket;
  std::vector<std::uint8_t> received;

  /// Reads what is there; false once the connection is over.
  bool receive() {
    std::array<std::uint8_t, kMostFrame> chunk{};
    const ssize_t count = recv(socket.get(), chunk.data(), chunk.size(), MSG_DONTWAIT);
    if (count < 0) {
      return errno == EAGAIN || errno == EWOULDBLOCK || errno == EINTR;
    }
    received.insert(received.end(), chunk.begin(), chunk.begin() + count);
    return count > 0;
  }

  /// The length of the request at the front once it is complete, 0 before.
  /// Throws ClientLost if these bytes can't be Modbus.
  std::size_t complete() const {
    if (received.size() < kHeader) {
      return 0;
    }
    const std::size_t length = 6 + word_at(received, 4);
    if (word_at(received, 2) != 0 || length < kHeader + 1 || length > kMostFrame) {
      throw ClientLost{};
    }
    return received.size() >= length ? length : 0;
  }
};

}  // namespace

struct ModbusTcpServer::Listener {
  std::unique_ptr<modbus_t, ContextDeleter> context;
  bridge::UniqueFd socket;
  std::string address;
};

ModbusTcpServer::ModbusTcpServer(const bridge::Endpoint& listen, const bridge::RegisterMap& map,
                                 ControllerPort& controller)
    : listener_(std::make_unique<Listener>()), requests_(map, controller) {
  const std::string port = std::to_string(listen.port);
  listener_->context.reset(modbus_new_tcp_pi(listen.host.c_str(), port.c_str()));
  if (!listener_->context) {
    throw std::runtime_error("stage.listen " + bridge::to_string(listen) + ": " +
                             modbus_strerror(errno));
  }
  errno = 0;
  listener_->socket = bridge::UniqueFd(modbus_tcp_pi_listen(listener_->context.get(), kBacklog));
  if (!listener_->socket.valid()) {
    const std::string why = errno == 0 ? "no such address on this machine" : modbus_strerror(errno);
    throw std::runtime_error("stage.listen " + bridge::to_string(listen) + ": " + why +
                             "; choose another address or port, or stop what listens there");
  }
  bridge::Endpoint found = listen;
  found.port = static_cast<std::uint16_t>(port_of(listener_->socket.get()));
  listener_->address = bridge::to_string(found);
}

ModbusTcpServer::~ModbusTcpServer() = default;

const std::string& ModbusTcpServer::address() const {
  return listener_->address;
}

void ModbusTcpServer::run(const std::stop_token& stop) {
  std::vector<Client> clients;
  while (!stop.stop_requested()) {
    std::vector<pollfd> waiting{{listener_->socket.get(), POLLIN, 0}};
    for (const Client& client : clients) {
      waiting.push_back({client.socket.get(), POLLIN, 0});
    }
    if (poll(waiting.data(), waiting.size(), kPollMilliseconds) <= 0) {
      continue;
    }
    std::vector<Client> staying;
    for (std::size_t i = 0; i < clients.size(); ++i) {
      Client& client = clients[i];
      try {
        bool open = waiting[i + 1].revents == 0 || client.receive();
        while (const std::size_t length = open ? client.complete() : 0) {
          const std::span frame = std::span(client.received).first(length);
          modbus_set_socket(listener_->context.get(), client.socket.get());
          if (!requests_.answer(listener_->context.get(), frame, frame.subspan(kHeader))) {
            throw ClientLost{};
          }
          client.received.erase(client.received.begin(),
                                client.received.begin() + static_cast<std::ptrdiff_t>(length));
        }
        if (open) {
          staying.push_back(std::move(client));
        }
      } catch (const ClientLost&) {
        continue;
      }
    }
    clients = std::move(staying);
    if (waiting[0].revents != 0) {
      bridge::UniqueFd socket(accept4(listener_->socket.get(), nullptr, nullptr, SOCK_CLOEXEC));
      if (socket.valid() && clients.size() < kMostClients) {
        const timeval patience{0, 200000};
        setsockopt(socket.get(), SOL_SOCKET, SO_SNDTIMEO, &patience, sizeof(patience));
        clients.push_back({std::move(socket), {}});
      }
    }
  }
}

}  // namespace biotomy::sim
