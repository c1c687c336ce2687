#include "sim/scenario/scenario.hpp"

#include <fstream>
#include <sstream>

#include <gtest/gtest.h>

#include "sim/scenario/fault_reader.hpp"

namespace biotomy::sim {
namespace {

Scenario read(const std::string& text) {
  return read_scenario(bridge::CheckedTable::parse(text, "scenario.toml"));
}

std::string refusal(const std::string& text) {
  try {
    read("about = \"a test\"\n" + text);
  } catch (const bridge::ConfigurationError& error) {
    EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << error.what();
    return error.what();
  }
  return "";
}

TEST(Scenario, SaysWhatBreaksWhenAndForHowLong) {
  const Scenario scenario = read(R"(
about = "The lamp dims, and now and then the feed stalls."
[events.lamp]
fault = "lamp_dims"
share = 0.3
when = { grind_finished = 4, delay = 1.5, every = 2, probability = 0.5 }
lasts = { captures = 3 }
[events.stall]
fault = "axis_stalls"
axis = "column"
lasts = { until = "reset" }
)");
  ASSERT_EQ(scenario.events.size(), 2U);
  const ScenarioEvent& lamp = scenario.events[0];
  EXPECT_EQ(lamp.name, "lamp");
  EXPECT_STREQ(name_of(lamp.fault), "lamp_dims");
  EXPECT_EQ(std::get<LampDims>(lamp.fault).share, 0.3);
  EXPECT_EQ(lamp.when.moment, Occasion::Moment::grind_finished);
  EXPECT_EQ(lamp.when.at, 4);
  EXPECT_EQ(lamp.when.delay_s, 1.5);
  EXPECT_EQ(lamp.when.every, 2);
  EXPECT_EQ(lamp.when.probability, 0.5);
  EXPECT_EQ(lamp.lasts.captures, 3);
  const ScenarioEvent& stall = scenario.events[1];
  EXPECT_EQ(std::get<AxisStalls>(stall.fault).axis, MachineAxis::column);
  EXPECT_EQ(stall.when.moment, Occasion::Moment::rig_time);
  EXPECT_EQ(stall.when.at, 0);
  EXPECT_TRUE(stall.lasts.until_reset);
  EXPECT_FALSE(stall.lasts.rig_seconds || stall.lasts.real_seconds || stall.lasts.captures ||
               stall.lasts.grinds);
}

TEST(Scenario, RefusesWhatItDoesNotKnowWithTheNearestName) {
  EXPECT_NE(refusal("[events.x]\nfault = \"lamp_ded\"\n").find("did you mean \"lamp_dead\"?"),
            std::string::npos);
  EXPECT_NE(refusal("[events.x]\nfault = \"lamp_dims\"\nshrae = 1\n").find("\"share\""),
            std::string::npos);
  EXPECT_NE(refusal("[events.x]\nfault = \"lamp_dead\"\nshare = 1\n").find("events.x.share"),
            std::string::npos);
  EXPECT_NE(refusal("[events.x]\nfault = \"lamp_dead\"\nwhen = { grind_start = 1 }\n")
                .find("\"grind_started\""),
            std::string::npos);
  EXPECT_NE(refusal("[event.x]\nfault = \"lamp_dead\"\n").find("\"events\""), std::string::npos);
}

TEST(Scenario, RefusesWhatContradictsItself) {
  const std::string lamp = "[events.x]\nfault = \"lamp_dead\"\n";
  EXPECT_NE(refusal(lamp + "when = { grind_started = 1, capture = 2 }\n").find("one moment"),
            std::string::npos);
  EXPECT_NE(refusal(lamp + "when = { grind_started = 1.5 }\n").find("whole"), std::string::npos);
  EXPECT_NE(refusal(lamp + "when = { capture = 1, every = 0.5 }\n").find("whole"),
            std::string::npos);
  EXPECT_NE(refusal(lamp + "when = { grind_started = 0 }\n").find("range"), std::string::npos);
  EXPECT_NE(refusal(lamp + "when = { probability = 1.1 }\n").find("range"), std::string::npos);
  EXPECT_NE(refusal(lamp + "lasts = { captures = 1, rig_seconds = 2 }\n").find("one measure"),
            std::string::npos);
  EXPECT_NE(refusal(lamp + "lasts = { until = \"dawn\" }\n").find("reset"), std::string::npos);
  EXPECT_NE(refusal("[events.x]\nfault = \"door_bounces\"\nperiod = 1\nopen = 1\n").find("period"),
            std::string::npos);
  EXPECT_NE(refusal("[events.x]\n").find("events.x.fault"), std::string::npos);
  EXPECT_NE(refusal("").find("[events.NAME]"), std::string::npos);
}

TEST(Scenario, ParsesOneEventForTheBench) {
  const ScenarioEvent event =
      parse_event("door", "fault = \"door_open\"\nlasts = { rig_seconds = 2 }");
  EXPECT_EQ(event.name, "door");
  EXPECT_TRUE(std::holds_alternative<DoorOpen>(event.fault));
  EXPECT_EQ(event.lasts.rig_seconds, 2);
  EXPECT_THROW(parse_event("door", "fault = \"door_open\"\nwide = 2"), bridge::ConfigurationError);
  EXPECT_THROW(parse_event("door", "fault = "), bridge::ConfigurationError);
}

TEST(Scenario, ListsItsFaultsInTheReadme) {
  std::ifstream file(BIOTOMY_ROOT "/sim/README.md");
  std::ostringstream text;
  text << file.rdbuf();
  EXPECT_NE(text.str().find(fault_reference()), std::string::npos)
      << "put this table into sim/README.md:\n"
      << fault_reference();
}

}  // namespace
}  // namespace biotomy::sim
