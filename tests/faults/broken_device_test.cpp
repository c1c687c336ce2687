// Devices break in the middle of a run, and are mended.
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include "tests/faults/device_run.hpp"
#include "tests/faults/recovery_table.hpp"
#include "tests/faults/wheel_stop.hpp"

namespace biotomy::tests {
namespace {

using testing::ContainsRegex;
using testing::IsEmpty;

struct BrokenDevice {
  std::string name;
  std::string event;   ///< without its moment
  std::string moment;  ///< of a layer to come, as in a scenario's `when`
  double delay_s;      ///< after it, rig time
  std::string state;   ///< in which the job then stands still
  std::string told;    ///< what the operator is told, a regular expression
};

std::string began_at(const SimulatedRig& rig, const std::string& name) {
  std::string at;
  for (const nlohmann::json& fault : rig.witnessed("fault_began")) {
    if (fault.at("name") == name) at = fault.at("time");
  }
  return at;
}

void break_and_mend(DeviceRun& run, const BrokenDevice& broken) {
  SCOPED_TRACE(broken.name);
  const std::int64_t layer = run.watch().look().at("committed").get<std::int64_t>() + 3;
  run.bench().begin_fault(broken.name, broken.event + "\nwhen = { " + broken.moment + " = " +
                                           std::to_string(layer) +
                                           ", delay = " + std::to_string(broken.delay_s) + " }\n");
  const nlohmann::json stopped = run.watch().await_stop();
  ASSERT_EQ(stopped.at("state"), broken.state) << told(stopped);
  EXPECT_THAT(told(stopped), ContainsRegex(broken.told));
  const std::string mended_at = now_utc();
  run.bench().end_fault(broken.name);
  const std::chrono::milliseconds took = run.recover(stopped);
  const SimulatedRig& rig = run.rig();
  // After a pass the wheel is being stopped anyway.
  const bool while_it_grinds = broken.moment == "grind_started";
  note_recovery({.fault = broken.name,
                 .told = told(stopped),
                 .to_stop = while_it_grinds
                                ? wheel_told_to_stop(rig.witness(), began_at(rig, broken.name),
                                                     mended_at, rig.plan().time_scale)
                                : std::nullopt,
                 .to_layer = took});
}

/// All in one run, which then ends with the stack of an undisturbed one.
void expect_each_to_be_survived(const RigPlan& plan, const std::vector<BrokenDevice>& devices) {
  DeviceRun run(plan);
  for (const BrokenDevice& broken : devices) {
    break_and_mend(run, broken);
    if (testing::Test::HasFatalFailure()) return;
  }
  run.job().finish();
  EXPECT_THAT(run.job().verdict(undisturbed_device_sample()), IsEmpty());
}

TEST(BrokenStage, StopsTheWheelAndLeavesARunThatGoesOnToItsEnd) {
  expect_each_to_be_survived(
      device_plan(kMostDeviceLayers),
      {
          {"feed stalls", "fault = \"axis_stalls\"\naxis = \"feed\"", "grind_started", 0.5,
           "faulted", "a drive"},
          {"traverse stalls", "fault = \"axis_stalls\"\naxis = \"traverse\"", "grind_started", 2.0,
           "faulted", "a drive"},
          {"column stalls", "fault = \"axis_stalls\"\naxis = \"column\"", "grind_finished", 0.1,
           "faulted", "a drive|the column"},
          {"column creeps", "fault = \"axis_creeps\"\naxis = \"column\"\nspeed = 8",
           "grind_finished", 0.1, "faulted", "a drive|the column"},
          {"feed's scale is wrong", "fault = \"axis_position_error\"\naxis = \"feed\"\nerror = 15",
           "grind_finished", 0.1, "faulted", "feed"},
          {"spindle does not start", "fault = \"spindle_wont_start\"", "grind_finished", 0.1,
           "faulted", "a drive.*spindle"},
          {"spindle does not stop", "fault = \"spindle_wont_stop\"", "grind_started", 2.0,
           "faulted", "a drive.*spindle"},
          {"spindle is overloaded", "fault = \"spindle_overload\"\nload = 200", "grind_started",
           2.0, "faulted", "spindle"},
          {"Modbus is silent", "fault = \"modbus_silent\"", "grind_started", 0.5, "faulted",
           "the controller does not answer"},
          {"controller without power", "fault = \"controller_power_cut\"", "grind_started", 0.5,
           "faulted", "the controller does not answer.*power"},
          {"lines are silent", "fault = \"lines_silent\"", "grind_started", 0.5, "faulted", "line"},
          // Seen after a second, in which layers go by.
          {"controller's heartbeat stops", "fault = \"controller_heartbeat_stops\"",
           "grind_started", 0.5, "faulted", "controller's heartbeat"},
      });
}

TEST(BrokenCamera, StopsTheWheelAndLeavesARunThatGoesOnToItsEnd) {
  expect_each_to_be_survived(
      device_plan(kMostDeviceLayers),
      {
          {"camera hangs", "fault = \"camera_hangs\"", "grind_finished", 0.1, "faulted", "camera"},
          {"camera vanishes", "fault = \"camera_vanishes\"", "grind_finished", 0.1, "faulted",
           "camera"},
          {"camera vanishes during a pass", "fault = \"camera_vanishes\"", "grind_started", 0.5,
           "faulted", "camera"},
          {"camera gives an old frame", "fault = \"camera_old_frame\"", "grind_finished", 0.1,
           "paused", "old picture"},
          {"camera gives an old frame under its number",
           "fault = \"camera_old_frame\"\nnumber = \"old\"", "grind_finished", 0.1, "paused",
           "earlier moment"},
          {"camera gives torn frames", "fault = \"camera_torn_frame\"", "grind_finished", 0.1,
           "paused", "torn"},
          {"camera gives black frames", "fault = \"camera_black_frame\"", "grind_finished", 0.1,
           "paused", "brightness.*camera"},
          {"lamp dies", "fault = \"lamp_dead\"", "grind_finished", 0.1, "paused",
           "brightness.*lamp"},
      });
}

RigPlan warm_plan(const std::string& more) {
  RigPlan plan = device_plan(8);
  plan.daemon_settings += "[safety]\ntemperature_delay_ms = 50\n" + more;
  return plan;
}

const BrokenDevice kCooler{"cooler fails",  "fault = \"cooler_fails\"\ntime_constant = 20",
                           "grind_started", 0.5,
                           "faulted",       "the block is at"};

TEST(BrokenCooler, StopsTheRunUntilAnOperatorGoesOn) {
  expect_each_to_be_survived(warm_plan(""), {kCooler});
}

TEST(BrokenCooler, HoldsARunThatGoesOnByItselfWhereItMay) {
  BrokenDevice cooler = kCooler;
  cooler.name = "cooler fails, temperature_resumes";
  cooler.state = "held";
  cooler.told = "the block, at";
  expect_each_to_be_survived(warm_plan("temperature_resumes = true\n"), {cooler});
}

}  // namespace
}  // namespace biotomy::tests
