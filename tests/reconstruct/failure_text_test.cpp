#include "reconstruct/failure_text.hpp"

#include <new>
#include <stdexcept>

#include <gtest/gtest.h>

namespace biotomy::reconstruct {
namespace {

TEST(FailureText, IsWhatTheErrorSays) {
  EXPECT_EQ(failure_text(std::runtime_error("3 µm is too much")), "3 µm is too much");
}

TEST(FailureText, IsOneLineWhateverALibrarySays) {
  EXPECT_EQ(failure_text(std::runtime_error("OpenCV: (-215)\r\n> a == b\n\nwhere\n")),
            "OpenCV: (-215) > a == b where");
}

TEST(FailureText, SaysThatMemoryIsShort) {
  EXPECT_EQ(failure_text(std::bad_alloc()), "there is not enough memory");
}

}  // namespace
}  // namespace biotomy::reconstruct
