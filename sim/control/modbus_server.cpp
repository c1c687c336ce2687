#include "sim/control/modbus_server.hpp"

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
constexpr int kNoException = 0;

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

struct ModbusServer::Listener {
  std::unique_ptr<modbus_t, ContextDeleter> context;
  bridge::UniqueFd socket;
  std::string address;
};

ModbusServer::ModbusServer(const bridge::Endpoint& listen, const bridge::RegisterMap& map,
                           ControllerPort& controller)
    : listener_(std::make_unique<Listener>()), registers_(map), controller_(controller) {
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

ModbusServer::~ModbusServer() = default;

const std::string& ModbusServer::address() const {
  return listener_->address;
}

void ModbusServer::run(const std::stop_token& stop) {
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
          answer(client.socket.get(), std::span(client.received).first(length));
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

void ModbusServer::answer(int client, std::span<const std::uint8_t> request) {
  if (!controller_.answers()) {
    return;
  }
  modbus_t* context = listener_->context.get();
  modbus_set_socket(context, client);
  const int exception = judge_request(request);
  int sent = 0;
  if (exception != kNoException) {
    sent = modbus_reply_exception(context, request.data(), static_cast<unsigned int>(exception));
  } else {
    registers_.show(controller_.read());
    modbus_mapping_t mapping{};
    mapping.nb_input_registers = static_cast<int>(registers_.input().size());
    mapping.tab_input_registers = registers_.input().data();
    mapping.nb_registers = static_cast<int>(registers_.holding().size());
    mapping.tab_registers = registers_.holding().data();
    sent = modbus_reply(context, request.data(), static_cast<int>(request.size()), &mapping);
  }
  modbus_set_socket(context, -1);
  if (sent < 0) {
    throw ClientLost{};
  }
}

/// The exception that a request is to be answered with; a write that is in order is carried out.
int ModbusServer::judge_request(std::span<const std::uint8_t> request) {
  const std::span<const std::uint8_t> body = request.subspan(kHeader);
  const int function = body[0];
  const bool reads =
      function == MODBUS_FC_READ_HOLDING_REGISTERS || function == MODBUS_FC_READ_INPUT_REGISTERS;
  if (!reads && function != MODBUS_FC_WRITE_SINGLE_REGISTER &&
      function != MODBUS_FC_WRITE_MULTIPLE_REGISTERS) {
    return MODBUS_EXCEPTION_ILLEGAL_FUNCTION;
  }
  if (body.size() < 5) {
    return MODBUS_EXCEPTION_ILLEGAL_DATA_VALUE;
  }
  const int address = word_at(body, 1);
  const std::uint16_t second = word_at(body, 3);
  if (reads) {
    const bool fits = second >= 1 && second <= MODBUS_MAX_READ_REGISTERS;
    return fits ? kNoException : MODBUS_EXCEPTION_ILLEGAL_DATA_VALUE;
  }
  if (function == MODBUS_FC_WRITE_SINGLE_REGISTER) {
    return take_write(address, std::span(&second, 1));
  }
  const std::size_t count = second;
  if (count < 1 || count > MODBUS_MAX_WRITE_REGISTERS || body.size() != 6 + 2 * count ||
      body[5] != 2 * count) {
    return MODBUS_EXCEPTION_ILLEGAL_DATA_VALUE;
  }
  std::vector<std::uint16_t> values(count);
  for (std::size_t i = 0; i < count; ++i) {
    values[i] = word_at(body, 6 + 2 * i);
  }
  return take_write(address, values);
}

int ModbusServer::take_write(int address, std::span<const std::uint16_t> values) {
  const RegisterWrite write = registers_.judge(address, static_cast<int>(values.size()));
  if (!write.allowed) {
    return MODBUS_EXCEPTION_ILLEGAL_DATA_ADDRESS;
  }
  if (write.heartbeat) {
    controller_.hear_master(registers_.heartbeat_after(address, values));
  }
  if (write.command &&
      controller_.submit(registers_.command_after(address, values)) == Acceptance::busy) {
    return MODBUS_EXCEPTION_SLAVE_OR_SERVER_BUSY;
  }
  registers_.write(address, values);
  return kNoException;
}

}  // namespace biotomy::sim
