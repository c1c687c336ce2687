#include "acquisition/service/counted_stage.hpp"

#include <gtest/gtest.h>

#include "tests/acquisition/fake_rig.hpp"

namespace biotomy::tests {
namespace {

using namespace acquisition;

TEST(CountedStage, CountsCallsAndTheirErrors) {
  FakeStage stage;
  LinkCounts counts;
  CountedStage counted(stage, counts);
  counted.identify();
  counted.exchange(1);
  counted.exchange(2);
  stage.silent = true;
  EXPECT_THROW(counted.exchange(3), bridge::DeviceError);
  EXPECT_EQ(counts.calls().at("identify"), 1U);
  EXPECT_EQ(counts.calls().at("exchange"), 3U);
  std::uint64_t errors = 0;
  for (const auto& [key, count] : counts.errors()) {
    EXPECT_EQ(key.first, "exchange");
    errors += count;
  }
  EXPECT_EQ(errors, 1U);
}

TEST(CountedStage, CountsACommandThatIsHandedOverAgain) {
  FakeStage stage;
  LinkCounts counts;
  CountedStage counted(stage, counts);
  stage.silent = true;
  for (const std::uint32_t sequence : {7U, 7U, 8U, 8U, 8U}) {
    EXPECT_THROW(counted.issue(sequence, {}), bridge::DeviceError);
  }
  EXPECT_EQ(counts.repeated_commands(), 3U);
  EXPECT_EQ(counts.calls().at("issue"), 5U);
}

}  // namespace
}  // namespace biotomy::tests
