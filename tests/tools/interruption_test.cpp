#include "tools/interruption.hpp"

#include <csignal>

#include <gtest/gtest.h>

namespace biotomy::tools {
namespace {

TEST(Interruption, IsAskedForByTheFirstSignal) {
  for (const int signal : {SIGINT, SIGTERM}) {
    const Interruption interruption;
    EXPECT_FALSE(interruption.asked());
    std::raise(signal);
    EXPECT_TRUE(interruption.asked());
  }
}

TEST(Interruption, LeavesSignalsAsTheyWere) {
  { const Interruption interruption; }
  struct sigaction now {};
  sigaction(SIGINT, nullptr, &now);
  EXPECT_EQ(now.sa_handler, SIG_DFL);
}

TEST(InterruptionDeathTest, EndsTheProcessTheSecondTime) {
  EXPECT_EXIT(
      {
        const Interruption interruption;
        std::raise(SIGTERM);
        std::raise(SIGTERM);
      },
      testing::KilledBySignal(SIGTERM), "");
}

}  // namespace
}  // namespace biotomy::tools
