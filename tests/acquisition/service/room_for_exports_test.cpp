#include "acquisition/service/room_for_exports.hpp"

#include <gtest/gtest.h>

namespace biotomy::acquisition {
namespace {

constexpr std::uint64_t kGigabyte = 1'000'000'000;

JobStatus status_with(std::int64_t room, std::int64_t layers, std::int64_t committed) {
  JobStatus status;
  status.disk_left_layers = room;
  status.layers = layers;
  status.committed = committed;
  return status;
}

TEST(RoomForExports, IsWhatTheRestOfTheJobLeavesOver) {
  // Of 1000 layers that fit, 300 are to come and 200 are the reserve.
  EXPECT_EQ(bytes_left_by_job(status_with(1000, 400, 100), 200, 100 * kGigabyte), 50 * kGigabyte);
  EXPECT_EQ(bytes_left_by_job(status_with(400, 400, 100), 200, 100 * kGigabyte), 0U);
  EXPECT_EQ(bytes_left_by_job(status_with(0, 400, 100), 200, 0), 0U);
}

TEST(RoomForExports, IsNearlyAllWhereNoJobNeedsIt) {
  EXPECT_EQ(bytes_left_by_job({}, 200, 100 * kGigabyte), 100 * kGigabyte - (1U << 30));
  EXPECT_EQ(bytes_left_by_job(status_with(1000, 400, 400), 0, 100 * kGigabyte),
            100 * kGigabyte - (1U << 30));
  EXPECT_EQ(bytes_left_by_job({}, 0, kGigabyte), 0U);
}

}  // namespace
}  // namespace biotomy::acquisition
