#include "acquisition/focus/focus_memory.hpp"

#include <gtest/gtest.h>

namespace biotomy::acquisition {
namespace {

FocusSettings settings() {
  FocusSettings focus;
  focus.start = {500.0};
  focus.step = {20.0};
  focus.largest_change = {40.0};
  focus.every_layers = 10;
  focus.search_below_ratio = 0.8;
  return focus;
}

FocusedLayer focused(std::int64_t layer, double position_um) {
  return {
      .layer = layer, .position = {position_um}, .sharpness = 0.5, .measures = nullptr, .step = {}};
}

TEST(FocusMemory, SearchesAnywhereAroundTheConfiguredStartAtFirst) {
  const FocusMemory memory(settings(), {20.0});
  EXPECT_NE(memory.why_search(1), nullptr);
  EXPECT_EQ(memory.predicted(1).value, 500.0);
  EXPECT_FALSE(memory.plan(1, false).largest_change);
}

TEST(FocusMemory, FollowsTheFaceByTheThicknessOfEachLayer) {
  FocusMemory memory(settings(), {20.0});
  memory.remember(focused(3, 640.0));
  EXPECT_EQ(memory.predicted(3).value, 640.0);
  EXPECT_EQ(memory.predicted(7).value, 720.0);
}

/// Layers from a search at `layer` to the next.
int wait_of(const FocusMemory& memory, std::int64_t layer) {
  int wait = 1;
  while (memory.why_search(layer + wait) == nullptr) ++wait;
  return wait;
}

TEST(FocusMemory, SearchesTheMoreSeldomTheBetterItKnowsWhereTheFocusIs) {
  FocusMemory memory(settings(), {20.0});
  memory.remember(focused(0, 640.0));
  EXPECT_EQ(wait_of(memory, 0), 5);
  memory.remember(focused(5, 740.5));
  EXPECT_EQ(wait_of(memory, 5), 10);
  memory.remember(focused(15, memory.predicted(15).value));
  EXPECT_EQ(wait_of(memory, 15), 10) << "every_layers is the most";
  memory.remember(focused(25, memory.predicted(25).value + 12.0));
  EXPECT_EQ(wait_of(memory, 25), 5);
  memory.remember(focused(30, memory.predicted(30).value - 12.0));
  EXPECT_EQ(wait_of(memory, 30), 2);
}

TEST(FocusMemory, TakesBackWhatSearchesFoundWhoseFrameWasNotKept) {
  FocusMemory memory(settings(), {20.0});
  memory.remember(focused(0, 640.0));
  EXPECT_EQ(memory.predicted(0).value, 640.0) << "it counts for its own layer";
  memory.keep();
  EXPECT_FALSE(memory.take_back());

  FocusedLayer window = focused(5, 1500.0);
  window.step = {80.0};
  window.measures = std::make_shared<const FrameMeasures>();
  memory.remember(window);
  memory.remember(focused(5, 1510.0));
  EXPECT_TRUE(memory.take_back());
  EXPECT_EQ(memory.predicted(5).value, 740.0);
  EXPECT_EQ(memory.plan(5, true).step.value, 20.0);
  EXPECT_EQ(memory.peak_measures(), nullptr);
  EXPECT_EQ(wait_of(memory, 0), 5);
  EXPECT_FALSE(memory.take_back());
}

TEST(FocusMemory, KnowsNothingAgainWhenTheFirstSearchIsTakenBack) {
  FocusMemory memory(settings(), {20.0});
  memory.remember(focused(1, 1500.0));
  EXPECT_TRUE(memory.take_back());
  EXPECT_FALSE(memory.knows_focus());
  EXPECT_EQ(memory.predicted(1).value, 500.0);
}

TEST(FocusMemory, FollowsADriftThatTheSearchesFound) {
  FocusMemory memory(settings(), {20.0});
  double position = 640.0;
  memory.remember(focused(0, position));
  for (int layer = 10; layer <= 60; layer += 10) {
    position += 10 * (20.0 + 0.8);
    memory.remember(focused(layer, position));
  }
  EXPECT_NEAR(memory.predicted(70).value, position + 208.0, 0.5);
}

TEST(FocusMemory, TakesALeapForANewBeginningAndNotForADrift) {
  FocusMemory memory(settings(), {20.0});
  memory.remember(focused(1, 640.0));
  memory.remember(focused(2, 720.0));
  EXPECT_EQ(memory.predicted(3).value, 740.0);
}

TEST(FocusMemory, SearchesWhenTheSharpnessFell) {
  FocusMemory memory(settings(), {20.0});
  memory.remember(focused(3, 640.0));
  memory.accepted(0.95);
  EXPECT_EQ(memory.why_search(4), nullptr);
  memory.accepted(0.79);
  EXPECT_STREQ(memory.why_search(5), "the sharpness fell");
  memory.remember(focused(5, 680.0));
  EXPECT_EQ(memory.why_search(6), nullptr);
}

TEST(FocusMemory, AllowsTheFocusToChangeByALimitForEachLayer) {
  FocusMemory memory(settings(), {20.0});
  memory.remember(focused(3, 640.0));
  EXPECT_EQ(memory.plan(4, false).largest_change->value, 40.0);
  EXPECT_EQ(memory.plan(13, false).largest_change->value, 400.0);
  EXPECT_FALSE(memory.plan(4, true).largest_change) << "the ladder looks everywhere";
}

TEST(FocusMemory, BeginsTheNextSearchWithTheStepThatSuitedTheLast) {
  FocusMemory memory(settings(), {20.0});
  FocusedLayer wide = focused(3, 640.0);
  wide.step = {70.0};
  memory.remember(wide);
  EXPECT_EQ(memory.plan(13, false).step.value, 70.0);
  wide.step = {3.0};
  memory.remember(wide);
  EXPECT_EQ(memory.plan(13, false).step.value, 20.0) << "never finer than configured";
}

TEST(FocusMemory, KeepsWhatWasMeasuredAtThePeakAndOfWhichLayer) {
  FocusMemory memory(settings(), {20.0});
  EXPECT_EQ(memory.peak_measures(), nullptr);
  FocusedLayer found = focused(3, 640.0);
  found.measures = std::make_shared<const FrameMeasures>();
  memory.remember(found);
  EXPECT_EQ(memory.peak_measures(), found.measures);
  EXPECT_EQ(memory.peak_layer(), 3);
}

}  // namespace
}  // namespace biotomy::acquisition
