// Who may read and command the daemon, and what `biotomy rig` says to a person who may not.
#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include "tests/integration/simulated_rig.hpp"

namespace biotomy::tests {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

RigPlan plan_with(const std::string& more) {
  RigPlan plan;
  plan.layers = 2;
  plan.width = 64;
  plan.height = 48;
  plan.daemon_settings = more;
  return plan;
}

struct RemoteControl : testing::Test {
  static constexpr const char* kWrong = "wrong-wrong-wrong-wrong";

  /// `biotomy rig WORDS` with another token than the rig's, or with none.
  static Outcome rig(const SimulatedRig& on, std::vector<std::string> words,
                     const std::string& token = "") {
    std::vector<std::string> command{BIOTOMY_TOOL, "rig"};
    for (std::string& word : words) command.push_back(std::move(word));
    command.insert(command.end(), {"--url", on.url()});
    if (!token.empty()) {
      const std::filesystem::path file = on.folder() / "other-token";
      std::ofstream(file) << token << "\n";
      command.insert(command.end(), {"--token-file", file});
    }
    return run(command, on.folder());
  }
};

TEST_F(RemoteControl, SaysWhatATokenIsNeededFor) {
  SimulatedRig on(plan_with("read = \"token\"\nfailed_tokens_per_minute = 2\n"));
  on.start_daemon();
  EXPECT_EQ(on.rig("status").exit_code, 0);

  const Outcome none = rig(on, {"status"});
  EXPECT_EQ(none.exit_code, 1);
  EXPECT_THAT(none.errors, AllOf(HasSubstr("wants a token"), HasSubstr("--token-file"),
                                 HasSubstr("BIOTOMY_TOKEN")));
  for (int i = 0; i < 2; ++i) {
    const Outcome wrong = rig(on, {"abort"}, kWrong);
    EXPECT_EQ(wrong.exit_code, 1);
    EXPECT_THAT(wrong.errors, HasSubstr("does not know the token"));
  }
  const Outcome often = rig(on, {"abort"}, kWrong);
  EXPECT_EQ(often.exit_code, 1);
  EXPECT_THAT(often.errors,
              AllOf(HasSubstr("turns this computer away"), HasSubstr("try again in")));

  const Outcome ended = on.end_daemon();
  EXPECT_THAT(ended.errors,
              AllOf(HasSubstr("refused 127.0.0.1: abort, a wrong token"), Not(HasSubstr(kWrong))));
}

TEST_F(RemoteControl, TellsPeopleApartByTheirNames) {
  SimulatedRig on(plan_with(""));
  std::ofstream(on.folder() / "token") << "anna 0123456789abcdef\nbert fedcba9876543210\n";
  ::chmod((on.folder() / "token").c_str(), 0600);
  on.start_daemon();
  EXPECT_EQ(rig(on, {"start", "--reason", "good evening"}, "bert fedcba9876543210").exit_code, 0);
  const Outcome ended = on.end_daemon();
  EXPECT_THAT(ended.errors, HasSubstr("start by bert from 127.0.0.1 (good evening)"));
}

TEST_F(RemoteControl, DoesNotStartOpenToOtherComputers) {
  SimulatedRig on(plan_with(""));
  const std::filesystem::path file = on.folder() / "rig.toml";
  std::ifstream stream(file);
  std::string text{std::istreambuf_iterator<char>(stream), {}};
  const std::string loopback = "127.0.0.1:0\"\ntoken_file";
  text.replace(text.find(loopback), loopback.size(), "0.0.0.0:0\"\ntoken_file");
  std::ofstream(file) << text;
  const Outcome outcome = run({BIOTOMY_DAEMON, "--config", file}, on.folder());
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_THAT(outcome.errors, AllOf(HasSubstr("service.listen"), HasSubstr("service.read"),
                                    HasSubstr("service.allow_remote = true")));
}

TEST_F(RemoteControl, DoesNotStartWithATokenThatOthersCanRead) {
  SimulatedRig on(plan_with(""));
  std::ofstream(on.folder() / "token") << "0123456789abcdef\n";
  ::chmod((on.folder() / "token").c_str(), 0644);
  const Outcome outcome = run({BIOTOMY_DAEMON, "--config", on.folder() / "rig.toml"}, on.folder());
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_THAT(outcome.errors, HasSubstr("chmod 600"));
}

}  // namespace
}  // namespace biotomy::tests
