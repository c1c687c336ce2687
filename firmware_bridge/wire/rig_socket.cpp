#include "firmware_bridge/wire/rig_socket.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <system_error>
#include <vector>

#include <poll.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

namespace biotomy::bridge {

namespace {

using Clock = std::chrono::steady_clock;
using Kind = RigSocketError::Kind;

std::string reason(int error) {
  return std::generic_category().message(error);
}

bool means_disconnected(int error) {
  return error == ECONNRESET || error == EPIPE || error == ENOTCONN || error == ECONNREFUSED ||
         error == ENOENT || error == ECONNABORTED;
}

[[noreturn]] void fail(const std::string& what, int error) {
  throw RigSocketError(means_disconnected(error) ? Kind::disconnected : Kind::failed,
                       what + ": " + reason(error));
}

sockaddr_un address_of(const std::filesystem::path& path) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  const std::string& text = path.native();
  if (text.empty() || text.size() >= sizeof address.sun_path) {
    throw RigSocketError(Kind::failed, "rig socket " + text + ": a socket's path has 1 to " +
                                           std::to_string(sizeof address.sun_path - 1) +
                                           " characters; choose a shorter one");
  }
  std::memcpy(address.sun_path, text.c_str(), text.size() + 1);
  return address;
}

UniqueFd make_socket() {
  UniqueFd socket(::socket(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0));
  if (!socket.valid()) fail("rig socket: no socket to be had", errno);
  return socket;
}

/// Waits until `deadline` for the socket to be ready; false if it is not.
bool wait_until(int socket, short events, Clock::time_point deadline) {
  while (true) {
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(deadline - Clock::now()).count();
    pollfd waited{.fd = socket, .events = events, .revents = 0};
    const int wait_ms = static_cast<int>(std::clamp<std::int64_t>(left, 0, 60'000));
    const int ready = ::poll(&waited, 1, wait_ms);
    if (ready > 0) return true;
    if (ready < 0 && errno != EINTR) fail("rig socket: poll", errno);
    if (Clock::now() >= deadline) return false;
  }
}

/// Every descriptor that came with a message, owned, so that none leaks whatever the message is.
std::vector<UniqueFd> take_descriptors(msghdr& header) {
  std::vector<UniqueFd> descriptors;
  for (cmsghdr* part = CMSG_FIRSTHDR(&header); part != nullptr; part = CMSG_NXTHDR(&header, part)) {
    if (part->cmsg_level != SOL_SOCKET || part->cmsg_type != SCM_RIGHTS) continue;
    const std::size_t count = (part->cmsg_len - CMSG_LEN(0)) / sizeof(int);
    for (std::size_t i = 0; i < count; ++i) {
      int descriptor = -1;
      std::memcpy(&descriptor, CMSG_DATA(part) + i * sizeof(int), sizeof(int));
      descriptors.emplace_back(descriptor);
    }
  }
  return descriptors;
}

bool somebody_listens(const sockaddr_un& address) {
  const UniqueFd probe(::socket(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC | SOCK_NONBLOCK, 0));
  if (!probe.valid()) fail("rig socket: cannot look whether somebody listens", errno);
  const int result =
      ::connect(probe.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address);
  return result == 0 || errno == EAGAIN;  // EAGAIN: it has callers enough
}

}  // namespace

RigConnection RigConnection::connect(const std::filesystem::path& path,
                                     std::chrono::milliseconds time_out) {
  const sockaddr_un address = address_of(path);
  UniqueFd socket = make_socket();
  // A listener with a full queue makes connect() wait; only the send time-out limits that wait.
  const auto wait = std::max(time_out, std::chrono::milliseconds(1));
  const timeval limit{.tv_sec = wait.count() / 1000,
                      .tv_usec = static_cast<suseconds_t>(wait.count() % 1000 * 1000)};
  if (::setsockopt(socket.get(), SOL_SOCKET, SO_SNDTIMEO, &limit, sizeof limit) != 0) {
    fail("rig socket " + path.string(), errno);
  }
  const Clock::time_point deadline = Clock::now() + wait;
  while (::connect(socket.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address) !=
         0) {
    if (errno == EINTR && Clock::now() < deadline) continue;
    if (errno == EAGAIN || errno == EINTR) {
      throw RigSocketError(Kind::timeout,
                           "rig socket " + path.string() + ": nobody took the connection in time");
    }
    fail("rig socket " + path.string() + ": is the rig's process running?", errno);
  }
  return RigConnection(std::move(socket));
}

void RigConnection::send(std::string_view text, std::chrono::milliseconds time_out,
                         int descriptor) {
  if (text.empty() || text.size() > kMostBytesInAPacket) {
    throw RigSocketError(Kind::malformed, "rig socket: a packet has 1 to 65536 bytes, not " +
                                              std::to_string(text.size()));
  }
  iovec content{.iov_base = const_cast<char*>(text.data()), .iov_len = text.size()};
  msghdr header{};
  header.msg_iov = &content;
  header.msg_iovlen = 1;
  alignas(cmsghdr) char control[CMSG_SPACE(sizeof(int))] = {};
  if (descriptor >= 0) {
    header.msg_control = control;
    header.msg_controllen = sizeof control;
    cmsghdr* part = CMSG_FIRSTHDR(&header);
    part->cmsg_level = SOL_SOCKET;
    part->cmsg_type = SCM_RIGHTS;
    part->cmsg_len = CMSG_LEN(sizeof(int));
    std::memcpy(CMSG_DATA(part), &descriptor, sizeof(int));
  }

  const Clock::time_point deadline = Clock::now() + time_out;
  while (::sendmsg(socket_.get(), &header, MSG_NOSIGNAL | MSG_DONTWAIT) < 0) {
    if (errno == EINTR) continue;
    if (errno != EAGAIN) fail("rig socket: sending", errno);
    if (!wait_until(socket_.get(), POLLOUT, deadline)) {
      throw RigSocketError(Kind::timeout, "rig socket: the other side takes no packets");
    }
  }
}

RigPacket RigConnection::receive(std::chrono::milliseconds time_out) {
  RigPacket packet;
  packet.text.resize(kMostBytesInAPacket);
  iovec content{.iov_base = packet.text.data(), .iov_len = packet.text.size()};
  // Room for two descriptors: with room for one, a second would go unnoticed on some kernels.
  alignas(cmsghdr) char control[CMSG_SPACE(2 * sizeof(int))];
  msghdr header{};

  const Clock::time_point deadline = Clock::now() + time_out;
  ssize_t received = -1;
  while (received < 0) {
    header = msghdr{};
    header.msg_iov = &content;
    header.msg_iovlen = 1;
    header.msg_control = control;
    header.msg_controllen = sizeof control;
    received = ::recvmsg(socket_.get(), &header, MSG_CMSG_CLOEXEC | MSG_DONTWAIT);
    if (received >= 0) break;
    if (errno == EINTR) continue;
    if (errno != EAGAIN) fail("rig socket: receiving", errno);
    if (!wait_until(socket_.get(), POLLIN, deadline)) {
      throw RigSocketError(Kind::timeout, "rig socket: no packet in time");
    }
  }

  std::vector<UniqueFd> descriptors = take_descriptors(header);
  if (received == 0) {
    // An end of file and an empty packet look the same; nobody of ours sends an empty packet.
    throw RigSocketError(Kind::disconnected, "rig socket: the other side closed the connection");
  }
  if ((header.msg_flags & MSG_TRUNC) != 0) {
    throw RigSocketError(Kind::malformed, "rig socket: a packet of more than 65536 bytes");
  }
  if (descriptors.size() > 1 || (header.msg_flags & MSG_CTRUNC) != 0) {
    throw RigSocketError(Kind::malformed,
                         "rig socket: a packet with more than one descriptor, or one that this "
                         "process has no room for");
  }
  packet.text.resize(static_cast<std::size_t>(received));
  if (!descriptors.empty()) packet.descriptor = std::move(descriptors.front());
  return packet;
}

bool RigConnection::wait(std::chrono::milliseconds time_out) const {
  return wait_until(socket_.get(), POLLIN, Clock::now() + time_out);
}

void RigConnection::shut_down() const {
  ::shutdown(socket_.get(), SHUT_RDWR);
}

RigListener::RigListener(const std::filesystem::path& path) : path_(path) {
  const sockaddr_un address = address_of(path);
  struct stat status {};
  if (::lstat(path.c_str(), &status) == 0) {
    if (!S_ISSOCK(status.st_mode)) {
      throw RigSocketError(Kind::failed, "rig socket " + path.string() +
                                             ": there is a file that is no socket; remove it");
    }
    if (somebody_listens(address)) {
      throw RigSocketError(Kind::failed, "rig socket " + path.string() +
                                             ": another process listens there; stop it first");
    }
    ::unlink(path.c_str());
  }

  UniqueFd socket = make_socket();
  if (::bind(socket.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0) {
    fail("rig socket " + path.string() + ": cannot be made", errno);
  }
  socket_ = std::move(socket);
  // Between bind() and listen() nobody can connect, so the rights are set in time.
  constexpr int kBacklog = 16;
  if (::chmod(path.c_str(), 0660) != 0 || ::listen(socket_.get(), kBacklog) != 0) {
    const int error = errno;
    ::unlink(path.c_str());
    fail("rig socket " + path.string(), error);
  }
}

RigListener::~RigListener() {
  ::unlink(path_.c_str());
}

std::optional<RigConnection> RigListener::accept(std::chrono::milliseconds time_out) {
  const Clock::time_point deadline = Clock::now() + time_out;
  while (wait_until(socket_.get(), POLLIN, deadline)) {
    UniqueFd socket(::accept4(socket_.get(), nullptr, nullptr, SOCK_CLOEXEC));
    if (socket.valid()) return RigConnection(std::move(socket));
    if (errno != EINTR && errno != ECONNABORTED && errno != EAGAIN) {
      fail("rig socket " + path_.string() + ": accepting", errno);
    }
  }
  return std::nullopt;
}

}  // namespace biotomy::bridge
