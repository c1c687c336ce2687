#include "reconstruct/excerpt.hpp"

#include <gtest/gtest.h>

namespace biotomy::reconstruct {
namespace {

TEST(Excerpt, LeavesShortTextAsItIs) {
  EXPECT_EQ(excerpt("3,4 µm"), "3,4 µm");
  EXPECT_EQ(excerpt(std::string(80, 'a')), std::string(80, 'a'));
  EXPECT_EQ(excerpt(""), "");
}

TEST(Excerpt, ShowsThatTheRestIsLeftOut) {
  EXPECT_EQ(excerpt(std::string(1'000'000, 'a')), std::string(80, 'a') + "…");
}

TEST(Excerpt, NeverCutsACharacterInTwo) {
  EXPECT_EQ(excerpt(std::string(79, 'a') + "µµ"), std::string(79, 'a') + "…");
}

TEST(Excerpt, KeepsToOneLine) {
  EXPECT_EQ(excerpt("a\nb\x1b[2Jc"), "a?b?[2Jc");
}

}  // namespace
}  // namespace biotomy::reconstruct
