#include "reconstruct/store/lru_map.hpp"

#include <string>

#include <gtest/gtest.h>

namespace biotomy::reconstruct {
namespace {

TEST(LruMap, DropsTheLongestUnusedWhenTheWeightIsTooMuch) {
  LruMap<int, std::string> map(10);
  map.put(1, "one", 4);
  map.put(2, "two", 4);
  ASSERT_NE(map.find(1), nullptr);  // 2 is the longest unused now
  map.put(3, "three", 4);
  EXPECT_EQ(map.find(2), nullptr);
  ASSERT_NE(map.find(1), nullptr);
  EXPECT_EQ(*map.find(3), "three");
}

TEST(LruMap, IsVisitedFromTheLongestUnusedOn) {
  LruMap<int, std::string> map(10);
  map.put(1, "one", 4);
  map.put(2, "two", 3);
  map.find(1);
  std::string seen;
  map.visit([&](int key, const std::string& value, std::size_t weight) {
    seen += std::to_string(key) + value + std::to_string(weight) + ' ';
  });
  EXPECT_EQ(seen, "2two3 1one4 ");
}

TEST(LruMap, KeepsTheLastEvenWhenItIsHeavierThanAll) {
  LruMap<int, int> map(10);
  map.put(1, 1, 5);
  map.put(2, 2, 50);
  EXPECT_EQ(map.find(1), nullptr);
  ASSERT_NE(map.find(2), nullptr);
}

TEST(LruMap, ForgetsTheWeightOfWhatIsReplaced) {
  LruMap<int, int> map(10);
  map.put(1, 1, 9);
  map.put(1, 2, 5);
  map.put(2, 2, 5);
  ASSERT_NE(map.find(1), nullptr);
  EXPECT_EQ(*map.find(1), 2);
}

}  // namespace
}  // namespace biotomy::reconstruct
