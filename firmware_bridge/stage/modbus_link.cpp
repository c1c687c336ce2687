#include "firmware_bridge/stage/modbus_link.hpp"

#include <algorithm>
#include <cerrno>
#include <utility>

#include <fcntl.h>
#include <modbus/modbus.h>
#include <sys/select.h>

#include "firmware_bridge/device_error.hpp"
#include "firmware_bridge/wire/endpoint.hpp"
#include "firmware_bridge/wire/unique_fd.hpp"

namespace biotomy::bridge {

namespace {

using Kind = DeviceError::Kind;

/// libmodbus before 3.1.12 waits with select(), which writes beyond its set for a descriptor of
/// 1024 or more. The lowest free number is the one that a new socket will get.
bool next_descriptor_suits_select() {
  const UniqueFd probe(::open("/dev/null", O_RDONLY | O_CLOEXEC));
  return probe.valid() && probe.get() < FD_SETSIZE;
}

/// An exception reply: the slave is there and says no, so the connection is in order.
bool is_exception_reply(int error) {
  return error > MODBUS_ENOBASE && error <= EMBXGTAR;
}

timeval to_timeval(std::chrono::milliseconds duration) {
  return {.tv_sec = duration.count() / 1000,
          .tv_usec = static_cast<suseconds_t>(duration.count() % 1000 * 1000)};
}

std::string describe_block(const char* verb, const char* table, int address, std::size_t count) {
  return std::string(verb) + " " + table + " registers " + std::to_string(address) + " to " +
         std::to_string(address + static_cast<int>(count) - 1);
}

}  // namespace

/// The open connection: libmodbus's context, connected.
struct ModbusLink::Connection {
  explicit Connection(modbus_t* opened) : context(opened) {}
  ~Connection() {
    modbus_close(context);  // a socket that was never opened is left alone
    modbus_free(context);
  }
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;

  modbus_t* context;
};

ModbusLink::ModbusLink(const ModbusLinkSettings& settings, Clock clock)
    : settings_(settings), clock_(std::move(clock)), not_before_(clock_()) {
  const Endpoint endpoint = parse_endpoint(settings.endpoint);
  if (endpoint.scheme == Endpoint::Scheme::rtu) {
    throw ConfigurationError("stage endpoint " + settings.endpoint +
                             ": Modbus RTU is not supported yet; use tcp://host:port");
  }
  if (endpoint.scheme != Endpoint::Scheme::tcp || endpoint.port == 0) {
    throw ConfigurationError("stage endpoint " + settings.endpoint +
                             ": expected tcp://host:port with a port from 1");
  }
  if (settings.unit_id < 1 || (settings.unit_id > 247 && settings.unit_id != MODBUS_TCP_SLAVE)) {
    throw ConfigurationError("stage endpoint " + settings.endpoint + ": unit id " +
                             std::to_string(settings.unit_id) + "; expected 1 to 247, or 255");
  }
  if (settings.response_timeout <= std::chrono::milliseconds(0) || settings.read_retries < 0 ||
      settings.reconnect_delay <= std::chrono::milliseconds(0)) {
    throw ConfigurationError("stage endpoint " + settings.endpoint +
                             ": the response time-out and the reconnect delay must be more than "
                             "0, the retries at least 0");
  }
}

ModbusLink::~ModbusLink() = default;

bool ModbusLink::connected() const {
  return connection_ != nullptr;
}

void ModbusLink::connect() {
  const Endpoint endpoint = parse_endpoint(settings_.endpoint);
  if (!next_descriptor_suits_select()) {
    disconnect_with_back_off();
    throw DeviceError(Kind::disconnected, "stage at " + settings_.endpoint +
                                              ": this process has more than 1000 open files; "
                                              "look for what keeps them open");
  }
  modbus_t* context =
      modbus_new_tcp_pi(endpoint.host.c_str(), std::to_string(endpoint.port).c_str());
  if (context == nullptr) {
    throw DeviceError(Kind::configuration,
                      "stage at " + settings_.endpoint +
                          ": not an address that libmodbus takes: " + modbus_strerror(errno));
  }
  auto connection = std::make_unique<Connection>(context);
  modbus_set_error_recovery(context, MODBUS_ERROR_RECOVERY_NONE);
  modbus_set_slave(context, settings_.unit_id);
  const timeval response = to_timeval(settings_.response_timeout);
  modbus_set_response_timeout(context, static_cast<std::uint32_t>(response.tv_sec),
                              static_cast<std::uint32_t>(response.tv_usec));
  // Without a time-out from byte to byte the one above holds for the whole answer: a slave that
  // sends a byte now and then can't draw it out.
  modbus_set_byte_timeout(context, 0, 0);

  if (modbus_connect(context) != 0) {
    const int error = errno;
    disconnect_with_back_off();
    throw DeviceError(Kind::disconnected, "stage at " + settings_.endpoint +
                                              ": cannot connect: " + modbus_strerror(error) +
                                              "; is the controller on and the cable in?");
  }
  connection_ = std::move(connection);
}

void ModbusLink::connect_if_due() {
  if (connection_) return;
  if (clock_() < not_before_) {
    throw DeviceError(Kind::disconnected, "stage at " + settings_.endpoint +
                                              ": not connected; the next try is due shortly");
  }
  connect();
}

void ModbusLink::disconnect_with_back_off() {
  connection_.reset();
  back_off_ = back_off_.count() == 0
                  ? settings_.reconnect_delay
                  : std::min(2 * back_off_,
                             std::max(settings_.reconnect_delay, settings_.reconnect_delay_max));
  not_before_ = clock_() + back_off_;
}

void ModbusLink::fail(const std::string& request, int error) {
  const std::string what =
      "stage at " + settings_.endpoint + ": " + request + ": " + modbus_strerror(error);
  if (error == EMBXGTAR) throw DeviceError(Kind::timeout, what);
  if (is_exception_reply(error)) {
    throw DeviceError(Kind::refused, what + "; does the register map fit this controller?");
  }
  // Anything else (the peer gone, an answer that isn't one) leaves the stream in doubt.
  disconnect_with_back_off();
  throw DeviceError(error == ETIMEDOUT ? Kind::timeout : Kind::disconnected, what);
}

void ModbusLink::read(RegisterTable table, int address, std::span<std::uint16_t> registers) {
  const std::string request =
      describe_block("reading", to_string(table), address, registers.size());
  connect_if_due();
  const auto function =
      table == RegisterTable::input ? modbus_read_input_registers : modbus_read_registers;
  for (int tries_left = settings_.read_retries;; --tries_left) {
    const int count = static_cast<int>(registers.size());
    const int received = function(connection_->context, address, count, registers.data());
    if (received == count) break;
    const int error = received < 0 ? errno : EMBBADDATA;
    if (error != ETIMEDOUT || tries_left == 0) fail(request, error);
    connection_.reset();
    connect();
  }
  back_off_ = std::chrono::milliseconds(0);
}

void ModbusLink::write(int address, std::span<const std::uint16_t> registers) {
  const std::string request = describe_block("writing", "holding", address, registers.size());
  connect_if_due();
  const int count = static_cast<int>(registers.size());
  const int written =
      modbus_write_registers(connection_->context, address, count, registers.data());
  if (written != count) fail(request, written < 0 ? errno : EMBBADDATA);
  back_off_ = std::chrono::milliseconds(0);
}

}  // namespace biotomy::bridge
