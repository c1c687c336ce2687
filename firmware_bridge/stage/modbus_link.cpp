#include "firmware_bridge/stage/modbus_link.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <random>
#include <system_error>
#include <utility>

#include <modbus/modbus.h>

#include "firmware_bridge/device_error.hpp"
#include "firmware_bridge/stage/modbus_connection.hpp"

namespace biotomy::bridge {

namespace {

using Kind = DeviceError::Kind;
using Scheme = Endpoint::Scheme;

/// USB adapters hand received bytes over in portions, up to 16 ms apart (FTDI's latency timer).
constexpr std::chrono::microseconds kAdapterLatency{20000};

/// After so many failures in a row the line is closed and left alone for a while.
constexpr int kFailuresBeforeBackOff = 2;

std::string describe_block(const char* verb, const char* table, int address, std::size_t count) {
  return std::string(verb) + " " + table + " registers " + std::to_string(address) + " to " +
         std::to_string(address + static_cast<int>(count) - 1);
}

void check(const ModbusLinkSettings& settings, const Endpoint& endpoint) {
  const auto refuse = [&](const std::string& what) {
    throw ConfigurationError("stage endpoint " + settings.endpoint + ": " + what);
  };
  const bool is_serial = endpoint.scheme == Scheme::rtu;
  if (!is_serial && (endpoint.scheme != Scheme::tcp || endpoint.port == 0)) {
    refuse("expected tcp://host:port with a port from 1, or rtu:///dev/name");
  }
  const bool is_device_without_unit = !is_serial && settings.unit_id == MODBUS_TCP_SLAVE;
  if ((settings.unit_id < 1 || settings.unit_id > 247) && !is_device_without_unit) {
    refuse("unit id " + std::to_string(settings.unit_id) + "; expected 1 to 247" +
           (is_serial ? "" : ", or 255"));
  }
  if (is_serial && !settings.echo_address) {
    refuse("a serial line needs a register that gives back what was written");
  }
  if (settings.response_timeout <= std::chrono::milliseconds(0) || settings.read_retries < 0 ||
      settings.reconnect_delay <= std::chrono::milliseconds(0)) {
    refuse(
        "the response time-out and the reconnect delay must be more than 0, the retries at least "
        "0");
  }
}

}  // namespace

ModbusLink::ModbusLink(const ModbusLinkSettings& settings, Clock clock)
    : settings_(settings),
      clock_(std::move(clock)),
      endpoint_(parse_endpoint(settings.endpoint)),
      // A number that an earlier run left in the echo register proves nothing.
      token_(static_cast<std::uint16_t>(std::random_device{}())),
      not_before_(clock_()) {
  check(settings, endpoint_);
  if (endpoint_.scheme == Scheme::tcp) addresses_.emplace(endpoint_.host, endpoint_.port);
}

ModbusLink::~ModbusLink() = default;

bool ModbusLink::connected() const {
  return connection_ != nullptr;
}

std::string ModbusLink::named(const std::string& what) const {
  return "stage at " + settings_.endpoint + ": " + what;
}

void ModbusLink::read(RegisterTable table, int address, std::span<std::uint16_t> registers) {
  const int count = static_cast<int>(registers.size());
  const bool is_input = table == RegisterTable::input;
  const auto function = is_input ? modbus_read_input_registers : modbus_read_registers;
  ask(describe_block("reading", to_string(table), address, registers.size()),
      {is_input ? MODBUS_FC_READ_INPUT_REGISTERS : MODBUS_FC_READ_HOLDING_REGISTERS, count},
      [&](ModbusConnection& connection) {
        return function(connection.context(), address, count, registers.data());
      });
}

void ModbusLink::write(int address, std::span<const std::uint16_t> registers) {
  const int count = static_cast<int>(registers.size());
  ask(describe_block("writing", "holding", address, registers.size()),
      {MODBUS_FC_WRITE_MULTIPLE_REGISTERS, count}, [&](ModbusConnection& connection) {
        return modbus_write_registers(connection.context(), address, count, registers.data());
      });
}

void ModbusLink::ask(const std::string& request, Shape shape, const Send& send) {
  const bool is_read = shape.function != MODBUS_FC_WRITE_MULTIPLE_REGISTERS;
  for (int tries_left = settings_.read_retries;; --tries_left) {
    // Getting ready does nothing that could be done twice: what fails in it may be tried again.
    std::optional<Failure> failure = get_ready(shape);
    bool may_repeat = true;
    if (!failure) {
      failure = ask_once(shape.count, send);
      may_repeat = is_read || (failure && failure->answer == Answer::malformed_request);
    }
    if (!failure) {
      last_ = shape;
      failures_ = 0;
      back_off_ = std::chrono::milliseconds(0);
      return;
    }
    const bool can_help =
        failure->answer == Answer::doubtful || failure->answer == Answer::malformed_request;
    if (!can_help || !may_repeat || tries_left == 0) {
      note_failure(failure->answer);
      fail(request, *failure);
    }
  }
}

/// One request over the open connection, and what its failure leaves of that.
std::optional<ModbusLink::Failure> ModbusLink::ask_once(int count, const Send& send) {
  errno = 0;
  const int done = send(*connection_);
  if (done == count) return std::nullopt;
  const Failure failure{answer_of(done < 0 ? errno : EMBBADDATA), done < 0 ? errno : EMBBADDATA};
  // An answer that says no is an answer: the connection is in order.
  if (failure.answer == Answer::exception || failure.answer == Answer::malformed_request) {
    return failure;
  }
  in_step_ = false;
  if (failure.answer == Answer::line_gone || endpoint_.scheme == Scheme::tcp) connection_.reset();
  return failure;
}

ModbusLink::Answer ModbusLink::answer_of(int error) {
  switch (error) {
    case EMBXILFUN:
    case EMBXILADD:
    case EMBXILVAL:
      return Answer::malformed_request;
    case ETIMEDOUT:
    case EMBBADCRC:
    case EMBBADDATA:
    case EMBBADEXC:
    case EMBMDATA:
    case EMBBADSLAVE:
      return Answer::doubtful;
    default:
      return error > MODBUS_ENOBASE && error <= EMBXGTAR ? Answer::exception : Answer::line_gone;
  }
}

std::optional<ModbusLink::Failure> ModbusLink::get_ready(Shape next) {
  const bool is_tcp = endpoint_.scheme == Scheme::tcp;
  // A second copy of an answer, or the other side's farewell: this connection is no good, and
  // nothing has been sent yet.
  if (is_tcp && connection_ && connection_->has_unasked_bytes()) connection_.reset();
  if (!connection_) {
    if (clock_() < not_before_) {
      throw DeviceError(Kind::disconnected, named("not connected; the next try is due shortly"));
    }
    connect();
  }
  if (is_tcp) return std::nullopt;
  const std::chrono::microseconds gap = settings_.serial.silence_between_frames();
  // A second copy of the last answer that is still on its way would do for the next one, too.
  if (last_ == next || connection_->has_unasked_bytes()) in_step_ = false;
  if (in_step_) in_step_ = connection_->wait_for_silence(gap, gap);
  return in_step_ ? std::nullopt : get_in_step();
}

/// Proves that the next answer on a serial line is that of the next question.
std::optional<ModbusLink::Failure> ModbusLink::get_in_step() {
  const std::chrono::microseconds frame = settings_.serial.duration_of(kMostCharactersInAFrame);
  const std::chrono::microseconds silence =
      settings_.serial.silence_between_frames() + kAdapterLatency;
  if (!connection_->wait_for_silence(silence, settings_.response_timeout + frame)) {
    return Failure{Answer::doubtful, EMBMDATA};
  }
  const std::uint16_t token = ++token_;
  std::optional<Failure> failure = ask_once(1, [&](ModbusConnection& connection) {
    return modbus_write_registers(connection.context(), *settings_.echo_address, 1, &token);
  });
  if (failure) return failure;
  std::uint16_t echo = 0;
  failure = ask_once(1, [&](ModbusConnection& connection) {
    return modbus_read_registers(connection.context(), *settings_.echo_address, 1, &echo);
  });
  if (failure) return failure;
  if (echo != token) return Failure{Answer::doubtful, EMBBADDATA};
  in_step_ = true;
  last_.reset();
  return std::nullopt;
}

void ModbusLink::connect() {
  in_step_ = false;
  try {
    if (endpoint_.scheme == Scheme::tcp) {
      connection_ = ModbusConnection::over_tcp(addresses_->connect(settings_.response_timeout),
                                               settings_.unit_id, settings_.response_timeout);
    } else {
      connection_ = ModbusConnection::over_serial(
          open_serial_line(endpoint_.path, settings_.serial), settings_.serial, settings_.unit_id,
          settings_.response_timeout);
    }
  } catch (const std::system_error& error) {
    note_failure(Answer::line_gone);
    const bool is_taken = error.code().value() == EWOULDBLOCK;
    throw DeviceError(Kind::disconnected,
                      named(std::string("cannot connect: ") + error.what() +
                            (is_taken ? "; another program has it"
                                      : "; is the controller on and the cable in?")));
  }
}

void ModbusLink::note_failure(Answer answer) {
  if (answer == Answer::exception || answer == Answer::malformed_request) return;
  if (++failures_ < kFailuresBeforeBackOff) return;
  connection_.reset();
  back_off_ = back_off_.count() == 0
                  ? settings_.reconnect_delay
                  : std::min(2 * back_off_,
                             std::max(settings_.reconnect_delay, settings_.reconnect_delay_max));
  not_before_ = clock_() + back_off_;
}

void ModbusLink::fail(const std::string& what, Failure failure) const {
  const std::string sentence = named(what + ": " + modbus_strerror(failure.error));
  switch (failure.answer) {
    case Answer::malformed_request:
      throw DeviceError(Kind::configuration,
                        sentence + "; the register map does not fit this controller");
    case Answer::exception:
      throw DeviceError(failure.error == EMBXGTAR ? Kind::timeout : Kind::refused, sentence);
    case Answer::line_gone:
      throw DeviceError(Kind::disconnected, sentence);
    default:
      throw DeviceError(Kind::timeout, sentence);
  }
}

}  // namespace biotomy::bridge
