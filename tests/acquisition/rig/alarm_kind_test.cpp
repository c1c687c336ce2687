#include "acquisition/rig/alarm_kind.hpp"

#include <set>
#include <string>

#include <gtest/gtest.h>

namespace biotomy::tests {
namespace {

using namespace acquisition;

TEST(AlarmKind, HasANameAndAnAdviceOfItsOwn) {
  std::set<std::string> names;
  std::set<std::string> advices;
  constexpr int kKinds = static_cast<int>(AlarmKind::ending) + 1;
  for (int i = 0; i < kKinds; ++i) {
    const auto kind = static_cast<AlarmKind>(i);
    const std::string text = advice(kind);
    names.insert(to_string(kind));
    advices.insert(text);
    EXPECT_TRUE(text.ends_with('.')) << to_string(kind);
    EXPECT_NE(text.find("cknowledge"), std::string::npos) << to_string(kind);
  }
  EXPECT_EQ(names.size(), static_cast<std::size_t>(kKinds));
  EXPECT_EQ(advices.size(), static_cast<std::size_t>(kKinds));
}

}  // namespace
}  // namespace biotomy::tests
