#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "firmware_bridge/stage/register_bus.hpp"
#include "firmware_bridge/stage/tcp_connection.hpp"
#include "firmware_bridge/wire/endpoint.hpp"
#include "firmware_bridge/wire/serial_line.hpp"

namespace biotomy::bridge {

class ModbusConnection;

struct ModbusLinkSettings {
  std::string endpoint;  ///< "tcp://host:port" or "rtu:///dev/name"
  SerialFormat serial{};
  int unit_id = 1;                    ///< 1 to 247; over TCP, 255 too
  std::optional<int> echo_address{};  ///< of a holding register that gives back what was written;
                                      ///< a serial line needs it
  std::chrono::milliseconds response_timeout{500};  ///< for a connection and for a whole answer
  int read_retries = 1;                             ///< more tries of a read without a good answer
  std::chrono::milliseconds reconnect_delay{100};   ///< after a second failure; then it doubles
  std::chrono::milliseconds reconnect_delay_max{1000};
};

/// The link to a Modbus slave, over TCP or over a serial line (RTU). One thread owns it.
///
/// It opens itself at the first call and again after a failure. The call after a first failure
/// tries at once; from the second failure in a row on a call fails at once with `disconnected`
/// until the back-off is over, so that nothing is sent, and nothing piles up, on a dead line. One
/// good answer ends the back-off.
///
/// A call never takes longer than this, with T the response time-out, R the retries and F the time
/// of the longest frame at the line's speed:
/// - over TCP (1 + R) × 2 T,
/// - over a serial line (1 + R) × (4 T + F).
///
/// What fails, and what then:
/// - no answer, or one that is damaged or not ours: a read is tried again; a write never is, since
///   whether it was done is for the caller to read back. Then `timeout`.
/// - the connection or the device is gone (reset, EIO, ENODEV …): it is closed, and `disconnected`.
/// - illegal function, address or value: asked once more, since a request that was damaged on its
///   way is answered so, too; then `configuration`: the register map doesn't fit.
/// - another exception, such as busy: `refused` (the gateway's "no answer": `timeout`).
///
/// A late answer is never taken for another question's. Over TCP each answer carries the number of
/// its question, and after any doubt the connection is closed. A serial line has no such number:
/// after any doubt, after opening, and between two questions whose answers look alike, late bytes
/// are waited out and thrown away, then a new number is written to the echo register and read back;
/// only when it comes back is an answer believed again.
class ModbusLink final : public RegisterBus {
 public:
  using Clock = std::function<std::chrono::steady_clock::time_point()>;

  /// Does not connect yet. Throws ConfigurationError for an endpoint or a setting that can't be,
  /// DeviceError when the host's name cannot be looked up at present.
  explicit ModbusLink(const ModbusLinkSettings& settings,
                      Clock clock = std::chrono::steady_clock::now);
  ~ModbusLink() override;

  void read(RegisterTable table, int address, std::span<std::uint16_t> registers) override;
  void write(int address, std::span<const std::uint16_t> registers) override;

  bool connected() const;

 private:
  enum class Answer { good, exception, malformed_request, doubtful, line_gone };
  struct Failure {
    Answer answer;
    int error;
  };
  /// What tells the answers to two questions apart on a serial line.
  struct Shape {
    int function;
    int count;  ///< of registers
    friend bool operator==(const Shape&, const Shape&) = default;
  };
  /// Sends one request and takes its answer: how many registers it was about, or -1 and errno.
  using Send = std::function<int(ModbusConnection&)>;

  static Answer answer_of(int error);
  void ask(const std::string& request, Shape shape, const Send& send);
  std::optional<Failure> ask_once(int count, const Send& send);
  std::optional<Failure> get_ready(Shape next);
  std::optional<Failure> get_in_step();
  void connect();
  void note_failure(Answer answer);
  [[noreturn]] void fail(const std::string& what, Failure failure) const;
  std::string named(const std::string& what) const;

  ModbusLinkSettings settings_;
  Clock clock_;
  Endpoint endpoint_;
  std::optional<TcpAddresses> addresses_;
  std::unique_ptr<ModbusConnection> connection_;
  bool in_step_ = false;
  std::optional<Shape> last_;  ///< the question that was answered last
  std::uint16_t token_;
  int failures_ = 0;  ///< calls in a row that ended without an answer
  std::chrono::steady_clock::time_point not_before_;
  std::chrono::milliseconds back_off_{0};
};

}  // namespace biotomy::bridge
