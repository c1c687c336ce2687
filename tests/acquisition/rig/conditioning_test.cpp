#include "acquisition/rig/conditioning.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace biotomy::acquisition {
namespace {

using std::chrono::seconds;
using testing::HasSubstr;

struct Cooling {
  SafetyLimits limits;
  Conditioning conditioning{limits};
  bridge::StageStatus status{};
  TimePoint now{};

  explicit Cooling(double block_c) {
    status.block_temperature_c = block_c;
    conditioning.begin(now);
  }
  bool after(seconds time) {
    now += time;
    return conditioning.poll(status, now);
  }
};

TEST(Conditioning, IsDoneAtOnceWithABlockThatIsColdAlready) {
  Cooling block(-30.0);
  EXPECT_TRUE(block.after(seconds(0)));
}

TEST(Conditioning, WaitsUntilTheBlockHasBeenInsideForAWhile) {
  Cooling block(0.0);
  EXPECT_FALSE(block.after(seconds(1)));
  EXPECT_THAT(block.conditioning.waiting_for(),
              HasSubstr("the block, at 0.0 °C, to be at -80.0 to -5.0"));
  block.status.block_temperature_c = -5.1;
  EXPECT_FALSE(block.after(seconds(1)));
  EXPECT_FALSE(block.after(seconds(4)));
  block.status.block_temperature_c = -4.9;  // and out again
  EXPECT_FALSE(block.after(seconds(1)));
  block.status.block_temperature_c = -5.1;
  EXPECT_FALSE(block.after(seconds(4)));
  EXPECT_FALSE(block.after(seconds(4)));
  EXPECT_TRUE(block.after(seconds(1)));
}

TEST(Conditioning, TakesSlowCoolingForProgress) {
  Cooling block(20.0);
  while (block.status.block_temperature_c > -5.0) {
    ASSERT_NO_THROW(block.after(seconds(590)));
    block.status.block_temperature_c -= block.limits.conditioning_progress_c;
  }
}

TEST(Conditioning, FailsWhenTheBlockDoesNotGetColder) {
  Cooling block(2.0);
  EXPECT_FALSE(block.after(seconds(1)));
  EXPECT_FALSE(block.after(seconds(599)));
  try {
    block.after(seconds(2));
    FAIL() << "it went on waiting";
  } catch (const StepFailure& failure) {
    EXPECT_THAT(failure.what(), HasSubstr("look at the cooling"));
    EXPECT_THAT(failure.what(), HasSubstr("at 2.0 °C"));
  }
}

TEST(Conditioning, WarmsUpABlockThatIsTooCold) {
  Cooling block(-90.0);
  EXPECT_FALSE(block.after(seconds(1)));
  block.status.block_temperature_c = -79.0;
  EXPECT_FALSE(block.after(seconds(1)));
  EXPECT_TRUE(block.after(seconds(6)));
}

}  // namespace
}  // namespace biotomy::acquisition
