#include "reconstruct/section/nearest_word.hpp"

#include <array>
#include <string>

#include <gtest/gtest.h>

namespace biotomy::reconstruct {
namespace {

constexpr std::array<std::string_view, 3> kWords{"bounding", "inscribed", "edge"};

TEST(NearestWord, IsTheOneWithTheFewestChanges) {
  EXPECT_EQ(nearest_word("inscribd", kWords), "inscribed");
  EXPECT_EQ(nearest_word("boundnig", kWords), "bounding");
  EXPECT_EQ(nearest_word("edges", kWords), "edge");
  EXPECT_EQ(nearest_word("edge", kWords), "edge");
}

TEST(NearestWord, IsNoneWhenTooMuchWouldHaveToChange) {
  EXPECT_EQ(nearest_word("everything", kWords), "");
  EXPECT_EQ(nearest_word(std::string(100'000, 'b'), kWords), "");
  EXPECT_EQ(nearest_word("edge", {}), "");
}

}  // namespace
}  // namespace biotomy::reconstruct
