#include "firmware_bridge/wire/rig_socket.hpp"

#include <array>
#include <cstring>
#include <fstream>
#include <thread>

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <unistd.h>

#include "tests/temporary_folder.hpp"

namespace biotomy::bridge {
namespace {

using namespace std::chrono_literals;
using Kind = RigSocketError::Kind;

struct RawPair {
  RawPair() {
    if (::socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0, ends) != 0) std::abort();
  }
  int ends[2];
};

/// Two ends in one process: ours, and one to misbehave with.
struct Ends {
  RawPair pair;
  RigConnection ours{UniqueFd(pair.ends[0])};
  UniqueFd raw{pair.ends[1]};
};

template <class Act>
Kind kind_of_failure(Act act) {
  try {
    act();
  } catch (const RigSocketError& error) {
    return error.kind();
  }
  ADD_FAILURE() << "nothing was thrown";
  return Kind::failed;
}

int open_descriptors() {
  int count = 0;
  for (int i = 0; i < 256; ++i) count += ::fcntl(i, F_GETFD) >= 0 ? 1 : 0;
  return count;
}

/// Sends `text` with `count` descriptors of /dev/null.
void send_with_descriptors(int socket, const std::string& text, std::size_t count) {
  const UniqueFd null(::open("/dev/null", O_RDONLY | O_CLOEXEC));
  std::vector<char> control(CMSG_SPACE(count * sizeof(int)));
  iovec content{const_cast<char*>(text.data()), text.size()};
  msghdr header{};
  header.msg_iov = &content;
  header.msg_iovlen = 1;
  header.msg_control = control.data();
  header.msg_controllen = control.size();
  cmsghdr* part = CMSG_FIRSTHDR(&header);
  part->cmsg_level = SOL_SOCKET;
  part->cmsg_type = SCM_RIGHTS;
  part->cmsg_len = CMSG_LEN(count * sizeof(int));
  for (std::size_t i = 0; i < count; ++i) {
    const int descriptor = null.get();
    std::memcpy(CMSG_DATA(part) + i * sizeof(int), &descriptor, sizeof(int));
  }
  ASSERT_GT(::sendmsg(socket, &header, 0), 0);
}

TEST(RigSocket, CarriesPacketsWholeBothWays) {
  const tests::TemporaryFolder folder;
  RigListener listener(folder / "rig.sock");
  RigConnection client = RigConnection::connect(folder / "rig.sock", 1s);
  std::optional<RigConnection> server = listener.accept(1s);
  ASSERT_TRUE(server);
  const std::string longest(kMostBytesInAPacket, 'x');
  client.send("one", 1s);
  client.send(longest, 1s);
  EXPECT_EQ(server->receive(1s).text, "one");
  EXPECT_EQ(server->receive(1s).text, longest);
  server->send("back", 1s);
  EXPECT_TRUE(client.wait(1s));
  EXPECT_EQ(client.receive(1s).text, "back");
}

TEST(RigSocket, CarriesADescriptorThatIsClosedOnExec) {
  Ends ends;
  RigConnection other{UniqueFd(::dup(ends.raw.get()))};
  const UniqueFd null(::open("/dev/null", O_RDONLY | O_CLOEXEC));
  other.send("here", 1s, null.get());
  const RigPacket packet = ends.ours.receive(1s);
  ASSERT_TRUE(packet.descriptor.valid());
  EXPECT_NE(packet.descriptor.get(), null.get());
  EXPECT_NE(::fcntl(packet.descriptor.get(), F_GETFD) & FD_CLOEXEC, 0);
}

TEST(RigSocket, GivesUpWaitingInTime) {
  Ends ends;
  EXPECT_FALSE(ends.ours.wait(1ms));
  EXPECT_EQ(kind_of_failure([&] { ends.ours.receive(1ms); }), Kind::timeout);
}

TEST(RigSocket, GivesUpSendingToAPeerThatTakesNothing) {
  Ends ends;
  const std::string text(kMostBytesInAPacket, 'x');
  EXPECT_EQ(kind_of_failure([&] {
              for (int i = 0; i < 1000; ++i) ends.ours.send(text, 1ms);
            }),
            Kind::timeout);
}

TEST(RigSocket, TellsThatThePeerIsGone) {
  Ends ends;
  ends.raw.reset();
  EXPECT_TRUE(ends.ours.wait(1s));
  EXPECT_EQ(kind_of_failure([&] { ends.ours.receive(1s); }), Kind::disconnected);
  EXPECT_EQ(kind_of_failure([&] { ends.ours.send("x", 1s); }), Kind::disconnected);
}

TEST(RigSocket, TellsThatNobodyListens) {
  const tests::TemporaryFolder folder;
  EXPECT_EQ(kind_of_failure([&] { RigConnection::connect(folder / "none.sock", 1s); }),
            Kind::disconnected);
}

TEST(RigSocket, SwallowsAPacketThatIsTooLongAndGoesOn) {
  Ends ends;
  const std::string too_long(kMostBytesInAPacket + 1, 'x');
  ASSERT_GT(::send(ends.raw.get(), too_long.data(), too_long.size(), 0), 0);
  ASSERT_GT(::send(ends.raw.get(), "ok", 2, 0), 0);
  EXPECT_EQ(kind_of_failure([&] { ends.ours.receive(1s); }), Kind::malformed);
  EXPECT_EQ(ends.ours.receive(1s).text, "ok");
}

TEST(RigSocket, RefusesToSendAPacketThatIsTooLongOrEmpty) {
  Ends ends;
  EXPECT_EQ(kind_of_failure([&] { ends.ours.send("", 1s); }), Kind::malformed);
  EXPECT_EQ(kind_of_failure([&] { ends.ours.send(std::string(65537, 'x'), 1s); }), Kind::malformed);
}

TEST(RigSocket, KeepsNoDescriptorOfAPacketWithSeveral) {
  Ends ends;
  const int before = open_descriptors();
  for (const std::size_t count : {2U, 5U}) {
    send_with_descriptors(ends.raw.get(), "many", count);
    EXPECT_EQ(kind_of_failure([&] { ends.ours.receive(1s); }), Kind::malformed);
  }
  EXPECT_EQ(open_descriptors(), before);
}

TEST(RigSocket, EndsAWaitFromAnotherThread) {
  Ends ends;
  std::thread other([&] { ends.ours.shut_down(); });
  EXPECT_EQ(kind_of_failure([&] { ends.ours.receive(10s); }), Kind::disconnected);
  other.join();
}

TEST(RigListener, ReplacesASocketThatNobodyListensOn) {
  const tests::TemporaryFolder folder;
  const std::filesystem::path path = folder / "rig.sock";
  {
    const RigListener listener(path);
    std::filesystem::create_hard_link(path, folder / "left.sock");
  }
  EXPECT_FALSE(std::filesystem::exists(path));
  EXPECT_NO_THROW(RigListener(folder / "left.sock"));
}

TEST(RigListener, LeavesAPathInUseAlone) {
  const tests::TemporaryFolder folder;
  const RigListener listener(folder / "rig.sock");
  EXPECT_EQ(kind_of_failure([&] { RigListener second(folder / "rig.sock"); }), Kind::failed);
  EXPECT_TRUE(std::filesystem::exists(folder / "rig.sock"));
  std::ofstream(folder / "notes.txt") << "mine";
  EXPECT_EQ(kind_of_failure([&] { RigListener third(folder / "notes.txt"); }), Kind::failed);
  EXPECT_TRUE(std::filesystem::exists(folder / "notes.txt"));
}

TEST(RigListener, RefusesAPathThatIsTooLong) {
  EXPECT_EQ(kind_of_failure([] { RigListener listener("/tmp/" + std::string(200, 'x')); }),
            Kind::failed);
}

TEST(RigListener, LetsOnlyItsOwnerAndGroupIn) {
  const tests::TemporaryFolder folder;
  const RigListener listener(folder / "rig.sock");
  struct stat status {};
  ASSERT_EQ(::stat(listener.path().c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 0777U, 0660U);
}

TEST(RigListener, GivesUpWaitingForACaller) {
  const tests::TemporaryFolder folder;
  RigListener listener(folder / "rig.sock");
  EXPECT_FALSE(listener.accept(1ms));
}

}  // namespace
}  // namespace biotomy::bridge
