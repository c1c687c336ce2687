#include "acquisition/records/volume_feed.hpp"

#include <stdexcept>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/acquisition/fake_rig.hpp"

namespace biotomy::tests {
namespace {

using acquisition::VolumeFeed;
using testing::ElementsAre;
using testing::Pair;

TEST(VolumeFeed, TakesManyLayersAtOnceWhenTheVolumeIsSlow) {
  HeldWorker worker;
  std::vector<std::pair<std::int64_t, bool>> appended;
  VolumeFeed feed(worker, [&](std::int64_t available, bool finish, const auto& progress) {
    appended.emplace_back(available, finish);
    progress(available);
  });
  feed.offer(1);
  feed.offer(2);
  feed.offer(3);
  worker.run();
  feed.finish(4);
  EXPECT_FALSE(feed.progress().finished);
  worker.run();
  EXPECT_THAT(appended, ElementsAre(Pair(3, false), Pair(4, true)));
  EXPECT_EQ(feed.progress().layers_present, 4);
  EXPECT_TRUE(feed.progress().finished);
}

TEST(VolumeFeed, TellsAFailureAndTriesAgainWithTheNextLayer) {
  InlineWorker worker;
  bool broken = true;
  VolumeFeed feed(worker, [&](std::int64_t available, bool, const auto& progress) {
    if (broken) throw std::runtime_error("disk full");
    progress(available);
  });
  feed.offer(1);
  EXPECT_EQ(feed.progress().failure, "disk full");
  EXPECT_FALSE(feed.progress().finished);
  broken = false;
  feed.offer(2);
  EXPECT_EQ(feed.progress().failure, "");
  EXPECT_EQ(feed.progress().layers_present, 2);
}

TEST(VolumeFeed, IsNotFinishedByALastLayerThatFails) {
  InlineWorker worker;
  bool broken = true;
  VolumeFeed feed(worker, [&](std::int64_t available, bool, const auto& progress) {
    if (broken) throw std::runtime_error("disk full");
    progress(available);
  });
  feed.finish(3);
  EXPECT_EQ(feed.progress().failure, "disk full");
  EXPECT_FALSE(feed.progress().finished);
  broken = false;
  feed.finish(3);
  EXPECT_TRUE(feed.progress().finished);
}

}  // namespace
}  // namespace biotomy::tests
