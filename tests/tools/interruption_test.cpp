#include "tools/interruption.hpp"

#include <csignal>

#include <gtest/gtest.h>

namespace biotomy::tools {
namespace {

TEST(InterruptionOfWork, IsRequestedByEitherSignalAndForgottenByTheNextOne) {
  for (const int signal : {SIGINT, SIGTERM}) {
    const Interruption interruption;
    EXPECT_FALSE(Interruption::requested());
    std::raise(signal);
    EXPECT_TRUE(Interruption::requested());
  }
}

TEST(InterruptionOfWork, LetsASecondSignalEndTheProgram) {
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
