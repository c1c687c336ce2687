#include "acquisition/service/spare_room.hpp"

#include <gtest/gtest.h>

namespace biotomy::tests {
namespace {

using namespace acquisition;

struct SpareRoomTest : testing::Test {
  JobStatus status;
  SafetyLimits limits;

  SpareRoomTest() {
    status.layers = 100;
    status.committed = 40;
    limits.disk_reserve_layers = 20;
  }
};

TEST_F(SpareRoomTest, LeavesRoomForEveryLayerToCome) {
  status.disk_left_layers = 999;
  EXPECT_EQ(bytes_to_spare(10'000'000, status, limits), 939U * 10'000U);
  status.disk_left_layers = 60;
  EXPECT_EQ(bytes_to_spare(10'000'000, status, limits), 0U);
  status.disk_left_layers = 0;
  EXPECT_EQ(bytes_to_spare(10'000'000, status, limits), 0U);
}

TEST_F(SpareRoomTest, LeavesTheReserveAtTheEnd) {
  status.committed = 100;
  status.disk_left_layers = 20;
  EXPECT_EQ(bytes_to_spare(10'000'000, status, limits), 0U);
  status.disk_left_layers = 99;
  EXPECT_EQ(bytes_to_spare(10'000'000, status, limits), 79U * 100'000U);
}

TEST_F(SpareRoomTest, LeavesHalfWhereNobodyKnows) {
  EXPECT_EQ(bytes_to_spare(10'000'000, status, limits), 5'000'000U);
}

TEST_F(SpareRoomTest, AsksTheDiskOfAFolderThatIsNotThereYet) {
  EXPECT_GT(bytes_to_spare("/proc/self/cwd/a/b", "/proc/self/cwd/sample", status, limits), 0U);
}

}  // namespace
}  // namespace biotomy::tests
