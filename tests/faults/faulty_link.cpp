#include "tests/faults/faulty_link.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <list>
#include <mutex>
#include <optional>
#include <stdexcept>
#include <thread>
#include <utility>
#include <vector>

#include <arpa/inet.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include "firmware_bridge/wire/endpoint.hpp"
#include "firmware_bridge/wire/serial_line.hpp"
#include "firmware_bridge/wire/unique_fd.hpp"
#include "sim/control/pseudo_terminal.hpp"

namespace biotomy::tests {

namespace {

using bridge::UniqueFd;
using Clock = std::chrono::steady_clock;
using Bytes = std::vector<std::uint8_t>;

constexpr auto kPoll = std::chrono::milliseconds(2);
constexpr std::size_t kMostMessage = 1024;
constexpr std::size_t kTcpHeader = 8;  // and the function code

enum Direction : std::size_t { kToSlave, kToMaster };

sockaddr_in loopback(std::uint16_t port) {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(port);
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  return address;
}

UniqueFd tcp_socket() {
  return UniqueFd(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0));
}

/// Nothing if the port can't be had just now.
std::optional<UniqueFd> listen_on(std::uint16_t port) {
  UniqueFd socket = tcp_socket();
  const int on = 1;
  setsockopt(socket.get(), SOL_SOCKET, SO_REUSEADDR, &on, sizeof on);
  const sockaddr_in address = loopback(port);
  if (::bind(socket.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0 ||
      ::listen(socket.get(), 16) != 0) {
    return std::nullopt;
  }
  return socket;
}

std::uint16_t port_of(const UniqueFd& socket) {
  sockaddr_in address{};
  socklen_t length = sizeof address;
  ::getsockname(socket.get(), reinterpret_cast<sockaddr*>(&address), &length);
  return ntohs(address.sin_port);
}

/// What a side doesn't take is lost, as on a wire.
void put(int descriptor, const Bytes& bytes) {
  const ssize_t sent = ::send(descriptor, bytes.data(), bytes.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
  if (sent < 0 && errno == ENOTSOCK) {
    [[maybe_unused]] const ssize_t written = ::write(descriptor, bytes.data(), bytes.size());
  }
}

/// A master's connection and its continuation to the slave.
struct Session {
  struct Message {
    Clock::time_point due;
    Direction direction;
    Bytes bytes;
  };

  UniqueFd master;  ///< not valid: a serial line's pseudo-terminal
  UniqueFd slave;
  std::vector<Message> under_way{};
  std::array<std::optional<Bytes>, 2> held_back{};
  std::array<bool, 2> broken_off{};  ///< a direction in which nothing comes any more
  std::optional<LinkFault> fault_of_answer{};
  bool master_gone = false;
  bool over = false;
};

}  // namespace

class FaultyLink::Line {
 public:
  Line(const std::string& endpoint, const std::filesystem::path& folder, const LinkFaultPlan& plan)
      : slave_(bridge::parse_endpoint(endpoint)), plan_(plan), dice_(plan.seed) {
    if (is_serial()) {
      path_ = folder / "faulty.line";
      terminal_.emplace(path_);
      sessions_.push_back({{}, bridge::open_serial_line(slave_.path, {})});
    } else {
      listener_ = listen_on(0);
      if (!listener_) throw std::runtime_error("no port for the faulty link");
      port_ = port_of(*listener_);
    }
    thread_ = std::thread([this] { run(); });
  }

  ~Line() {
    is_stopping_ = true;
    thread_.join();
  }

  std::string endpoint() const {
    return is_serial() ? "rtu://" + path_.string() : "tcp://127.0.0.1:" + std::to_string(port_);
  }

  LinkFaultCounts counts() const {
    const std::lock_guard lock(mutex_);
    return counts_;
  }

 private:
  bool is_serial() const { return slave_.scheme == bridge::Endpoint::Scheme::rtu; }
  bool is_open() const { return is_serial() ? terminal_.has_value() : listener_.has_value(); }

  void run() {
    while (!is_stopping_) {
      if (!is_open() && Clock::now() >= reopen_at_) reopen();
      for (const auto& [session, direction] : readable()) {
        if (!session->over) pass(*session, direction);
      }
      for (Session& session : sessions_) deliver(session);
      sessions_.remove_if([](const Session& session) { return session.over; });
    }
  }

  int descriptor_of(const Session& session, Direction from) const {
    if (from == kToMaster) return session.slave.get();
    if (session.master_gone) return -1;
    return is_serial() ? (terminal_ ? terminal_->descriptor() : -1) : session.master.get();
  }

  /// The sessions with a message to be read, and where it goes. New masters are let in.
  std::vector<std::pair<Session*, Direction>> readable() {
    std::vector<pollfd> waited;
    std::vector<std::pair<Session*, Direction>> sources;
    for (Session& session : sessions_) {
      for (const Direction direction : {kToSlave, kToMaster}) {
        waited.push_back({descriptor_of(session, direction), POLLIN, 0});
        sources.emplace_back(&session, direction);
      }
    }
    if (listener_) waited.push_back({listener_->get(), POLLIN, 0});
    std::vector<std::pair<Session*, Direction>> found;
    if (::poll(waited.data(), waited.size(), static_cast<int>(kPoll.count())) <= 0) return found;
    for (std::size_t i = 0; i < sources.size(); ++i) {
      if (waited[i].revents != 0) found.push_back(sources[i]);
    }
    if (listener_ && waited.back().revents != 0) let_in();
    return found;
  }

  void let_in() {
    UniqueFd master(::accept4(listener_->get(), nullptr, nullptr, SOCK_CLOEXEC));
    UniqueFd slave = tcp_socket();
    const sockaddr_in address = loopback(slave_.port);
    // A slave that is not there: the master finds its connection closed.
    if (master.valid() &&
        ::connect(slave.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0) {
      sessions_.push_back({std::move(master), std::move(slave)});
    }
  }

  /// Takes a message and sends it on its way, or a fault in its place.
  void pass(Session& session, Direction direction) {
    std::array<std::uint8_t, kMostMessage> chunk{};
    const ssize_t count = ::read(descriptor_of(session, direction), chunk.data(), chunk.size());
    if (count < 0 && (errno == EAGAIN || errno == EINTR)) return;
    if (count <= 0) {
      lose(session, direction);
      return;
    }
    if (session.broken_off[direction]) return;
    Bytes bytes(chunk.begin(), chunk.begin() + count);
    std::optional<LinkFault> fault;
    if (direction == kToSlave) {
      fault = throw_dice();
      // Half of the faults fall on the answer.
      session.fault_of_answer = std::nullopt;
      if (fault && one_of(2) == 0) session.fault_of_answer = std::exchange(fault, std::nullopt);
    } else {
      fault = std::exchange(session.fault_of_answer, std::nullopt);
    }
    if (fault) {
      spoil(session, direction, std::move(bytes), *fault);
    } else {
      send(session, direction, std::move(bytes), Clock::now());
    }
  }

  std::optional<LinkFault> throw_dice() {
    const std::lock_guard lock(mutex_);
    ++counts_.exchanges;
    double thrown = std::uniform_real_distribution<>(0.0, 1.0)(dice_);
    for (std::size_t fault = 0; fault < plan_.share.size(); ++fault) {
      thrown -= plan_.share[fault];
      if (thrown < 0.0) {
        ++counts_.faults[fault];
        return static_cast<LinkFault>(fault);
      }
    }
    return std::nullopt;
  }

  std::size_t one_of(std::size_t count) {
    return std::uniform_int_distribution<std::size_t>(0, count - 1)(dice_);
  }

  Clock::duration some_time() {
    const auto longest = std::chrono::microseconds(plan_.longest_delay).count();
    return std::chrono::microseconds(one_of(static_cast<std::size_t>(longest) + 1));
  }

  void spoil(Session& session, Direction direction, Bytes bytes, LinkFault fault) {
    const Clock::time_point now = Clock::now();
    switch (fault) {
      case LinkFault::delay:
        send(session, direction, std::move(bytes), now + some_time());
        return;
      case LinkFault::drop:
        return;
      case LinkFault::duplicate:
        send(session, direction, bytes, now);
        send(session, direction, std::move(bytes), one_of(2) == 0 ? now : now + some_time());
        return;
      case LinkFault::truncate:
        bytes.resize(std::max<std::size_t>(1, one_of(bytes.size())));
        if (!is_serial()) break_off(session, direction);
        send(session, direction, std::move(bytes), now);
        return;
      case LinkFault::corrupt: {
        const std::size_t end = is_serial() ? bytes.size() : std::min(kTcpHeader, bytes.size());
        bytes[one_of(end)] ^= static_cast<std::uint8_t>(1U << one_of(8));
        send(session, direction, std::move(bytes), now);
        return;
      }
      case LinkFault::reorder:
        session.held_back[direction] = std::move(bytes);
        return;
      case LinkFault::cut:
        cut();
        return;
    }
  }

  /// TCP loses nothing from the middle of a stream: what was to follow the bytes that are missing
  /// never comes. On a serial line it does, and the frames' check tells.
  static void break_off(Session& session, Direction direction) {
    session.broken_off[direction] = true;
    session.held_back[direction].reset();
    std::erase_if(session.under_way,
                  [&](const Session::Message& message) { return message.direction == direction; });
  }

  void send(Session& session, Direction direction, Bytes bytes, Clock::time_point due) const {
    if (is_serial()) {
      for (const Session::Message& message : session.under_way) {
        if (message.direction == direction) due = std::max(due, message.due);
      }
    }
    session.under_way.push_back({due, direction, std::move(bytes)});
    if (std::optional<Bytes> held = std::exchange(session.held_back[direction], std::nullopt)) {
      session.under_way.push_back({due, direction, std::move(*held)});
    }
  }

  void deliver(Session& session) {
    const Clock::time_point now = Clock::now();
    auto& messages = session.under_way;
    for (const Session::Message& message : messages) {
      if (message.due > now) continue;
      const Direction back = message.direction == kToSlave ? kToMaster : kToSlave;
      put(descriptor_of(session, back), message.bytes);
    }
    std::erase_if(messages, [&](const Session::Message& message) { return message.due <= now; });
    // What a master has sent arrives, also when it has closed its connection meanwhile.
    const bool nothing_left =
        std::none_of(messages.begin(), messages.end(),
                     [](const Session::Message& message) { return message.direction == kToSlave; });
    if (session.master_gone && nothing_left) session.over = true;
  }

  /// One side has closed its connection.
  void lose(Session& session, Direction from) {
    if (is_serial()) return;
    if (from == kToMaster) {
      session.over = true;
      return;
    }
    session.master_gone = true;
    session.master.reset();
    if (std::optional<Bytes> held = std::exchange(session.held_back[kToSlave], std::nullopt)) {
      session.under_way.push_back({Clock::now() + some_time(), kToSlave, std::move(*held)});
    }
  }

  void cut() {
    reopen_at_ = Clock::now() + some_time();
    listener_.reset();
    terminal_.reset();
    for (Session& session : sessions_) {
      session.under_way.clear();
      session.held_back = {};
      session.over = !is_serial();
    }
  }

  void reopen() {
    if (is_serial()) {
      terminal_.emplace(path_);
    } else {
      listener_ = listen_on(port_);
    }
  }

  bridge::Endpoint slave_;
  LinkFaultPlan plan_;
  std::mt19937_64 dice_;
  std::filesystem::path path_;
  std::uint16_t port_ = 0;
  std::optional<UniqueFd> listener_;
  std::optional<sim::PseudoTerminal> terminal_;
  std::list<Session> sessions_;
  Clock::time_point reopen_at_{};
  mutable std::mutex mutex_;
  LinkFaultCounts counts_;
  std::atomic<bool> is_stopping_ = false;
  std::thread thread_;
};

FaultyLink::FaultyLink(const std::string& endpoint, const std::filesystem::path& folder,
                       const LinkFaultPlan& plan)
    : line_(std::make_unique<Line>(endpoint, folder, plan)) {}

FaultyLink::~FaultyLink() = default;

std::string FaultyLink::endpoint() const {
  return line_->endpoint();
}

LinkFaultCounts FaultyLink::counts() const {
  return line_->counts();
}

}  // namespace biotomy::tests
