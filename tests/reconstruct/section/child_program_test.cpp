#include "reconstruct/section/child_program.hpp"

#include <csignal>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <sys/wait.h>
#include <unistd.h>

#include "reconstruct/errors.hpp"
#include "tests/reconstruct/test_files.hpp"

namespace biotomy::reconstruct {
namespace {

using testing::HasSubstr;

std::vector<std::byte> bytes_of(const std::string& text) {
  const auto* data = reinterpret_cast<const std::byte*>(text.data());
  return {data, data + text.size()};
}

bool has_children() {
  return ::waitpid(-1, nullptr, WNOHANG) >= 0;
}

TEST(ChildProgram, IsFedAndHeard) {
  ChildProgram program({"sh", "-c", "cat; echo one >&2; echo two >&2"});
  EXPECT_TRUE(program.feed(bytes_of("some ")));
  EXPECT_TRUE(program.feed(bytes_of("words")));
  EXPECT_EQ(program.finish(), 0);
  EXPECT_EQ(program.output(), "some words");
  EXPECT_EQ(program.last_words(), "two");
}

TEST(ChildProgram, TellsHowItEnded) {
  EXPECT_EQ(ChildProgram({"sh", "-c", "exit 7"}).finish(), 7);
  EXPECT_EQ(ChildProgram({"sh", "-c", "kill -TERM $$"}).finish(), 128 + SIGTERM);
}

TEST(ChildProgram, ThatDiesWhileItIsFedRaisesNoSignal) {
  ChildProgram program({"sh", "-c", "exit 1"});
  const std::vector<std::byte> much(1'000'000);
  bool taken = true;
  for (int i = 0; i < 100 && taken; ++i) {
    taken = program.feed(much);
  }
  EXPECT_FALSE(taken);
  EXPECT_EQ(program.finish(), 1);
}

TEST(ChildProgram, IsKilledAndNoZombieWhenItIsNotWanted) {
  {
    ChildProgram program({"sleep", "1000"});
    EXPECT_TRUE(has_children());
  }
  EXPECT_FALSE(has_children());
}

TEST(ChildProgram, ThatIsNotInstalledIsNamed) {
  EXPECT_THAT(message_of<SampleError>([] { ChildProgram({"no-such-program-at-all"}); }),
              HasSubstr("no-such-program-at-all"));
  EXPECT_FALSE(has_children());
}

TEST(ChildProgram, HasAProcessGroupOfItsOwn) {
  ChildProgram program({"sh", "-c", "ps -o pgid= -p $$ | tr -d ' \\n'"});
  EXPECT_EQ(program.finish(), 0);
  EXPECT_NE(program.output(), std::to_string(::getpgrp()));
}

}  // namespace
}  // namespace biotomy::reconstruct
