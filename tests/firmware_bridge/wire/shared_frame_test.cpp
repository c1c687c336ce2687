#include "firmware_bridge/wire/shared_frame.hpp"

#include <algorithm>

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/mman.h>
#include <unistd.h>

#include "firmware_bridge/wire/rig_socket.hpp"

namespace biotomy::bridge {
namespace {

UniqueFd sealed_frame(std::size_t size) {
  FrameMemory memory(size);
  std::fill(memory.bytes().begin(), memory.bytes().end(), std::byte{7});
  return memory.seal();
}

TEST(SharedFrame, ShowsTheReceiverWhatTheSenderWrote) {
  const UniqueFd descriptor = sealed_frame(10000);
  const MappedFrame frame(descriptor, 10000);
  ASSERT_EQ(frame.bytes().size(), 10000U);
  EXPECT_EQ(std::count(frame.bytes().begin(), frame.bytes().end(), std::byte{7}), 10000);
}

TEST(SharedFrame, CanNeitherBeWrittenNorShrunkOnceSealed) {
  const UniqueFd descriptor = sealed_frame(100);
  EXPECT_EQ(::pwrite(descriptor.get(), "x", 1, 0), -1);
  EXPECT_EQ(::ftruncate(descriptor.get(), 10), -1);
  EXPECT_EQ(::fcntl(descriptor.get(), F_ADD_SEALS, F_SEAL_FUTURE_WRITE), -1);
}

TEST(SharedFrame, IsRefusedAtAnotherSize) {
  const UniqueFd descriptor = sealed_frame(100);
  EXPECT_THROW(MappedFrame(descriptor, 99), RigSocketError);
  EXPECT_THROW(MappedFrame(descriptor, 101), RigSocketError);
}

TEST(SharedFrame, IsRefusedWithoutEverySealThatMatters) {
  for (const int seals : {0, F_SEAL_SHRINK, F_SEAL_WRITE, F_SEAL_GROW}) {
    const UniqueFd descriptor(::memfd_create("test", MFD_CLOEXEC | MFD_ALLOW_SEALING));
    ASSERT_EQ(::ftruncate(descriptor.get(), 100), 0);
    ASSERT_EQ(::fcntl(descriptor.get(), F_ADD_SEALS, seals), 0);
    EXPECT_THROW(MappedFrame(descriptor, 100), RigSocketError) << seals;
  }
}

TEST(SharedFrame, IsRefusedWhenItIsNoSharedMemory) {
  EXPECT_THROW(MappedFrame(UniqueFd(), 100), RigSocketError);
  const UniqueFd zero(::open("/dev/zero", O_RDONLY | O_CLOEXEC));
  EXPECT_THROW(MappedFrame(zero, 100), RigSocketError);
}

}  // namespace
}  // namespace biotomy::bridge
