#include "acquisition/focus/focus_memory.hpp"

#include <gtest/gtest.h>

namespace biotomy::acquisition {
namespace {

FocusSettings settings() {
  FocusSettings focus;
  focus.start = {500.0};
  focus.every_layers = 10;
  focus.search_below_ratio = 0.8;
  return focus;
}

TEST(FocusMemory, SearchesAroundTheConfiguredStartAtFirst) {
  const FocusMemory memory(settings(), {20.0});
  EXPECT_NE(memory.why_search(1), nullptr);
  EXPECT_EQ(memory.predicted(1).value, 500.0);
}

TEST(FocusMemory, FollowsTheFaceByTheThicknessOfEachLayer) {
  FocusMemory memory(settings(), {20.0});
  memory.remember(3, {{640.0}, 0.5});
  EXPECT_EQ(memory.predicted(3).value, 640.0);
  EXPECT_EQ(memory.predicted(7).value, 720.0);
  EXPECT_EQ(memory.why_search(12), nullptr);
  EXPECT_NE(memory.why_search(13), nullptr);
}

TEST(FocusMemory, SearchesWhenTheSharpnessFell) {
  FocusMemory memory(settings(), {20.0});
  memory.remember(3, {{640.0}, 0.5});
  memory.accepted(0.95);
  EXPECT_EQ(memory.why_search(4), nullptr);
  memory.accepted(0.79);
  EXPECT_STREQ(memory.why_search(5), "the sharpness fell");
  memory.remember(5, {{680.0}, 0.5});
  EXPECT_EQ(memory.why_search(6), nullptr);
}

}  // namespace
}  // namespace biotomy::acquisition
