#include <string>

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include "tests/faults/device_run.hpp"

namespace biotomy::tests {
namespace {

using testing::HasSubstr;

TEST(UngroundFace, PausesAndIsNeitherStoredNorGroundBlindly) {
  DeviceRun run(device_plan(8));
  run.bench().begin_fault("wheel",
                          "fault = \"grind_removes_nothing\"\nwhen = { grind_started = 4 }");
  const nlohmann::json stopped = run.watch().await_stop();
  EXPECT_EQ(stopped.at("state"), "paused");
  EXPECT_EQ(stopped.at("committed"), 3);
  EXPECT_THAT(told(stopped), HasSubstr("the grind removed nothing"));

  run.bench().end_fault("wheel");
  run.job().go_on();
  const nlohmann::json again = run.watch().await_stop();
  EXPECT_EQ(again.at("state"), "paused");
  EXPECT_EQ(again.at("committed"), 3);
  EXPECT_EQ(run.rig().witnessed("grind_pass").size(), 4);
}

}  // namespace
}  // namespace biotomy::tests
