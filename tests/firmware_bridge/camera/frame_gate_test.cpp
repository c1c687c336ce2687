#include "firmware_bridge/camera/frame_gate.hpp"

#include <gtest/gtest.h>

namespace biotomy::bridge {
namespace {

using std::chrono::microseconds;
using std::chrono::milliseconds;
using std::chrono::nanoseconds;

constexpr SettingsOffered kAll{.exposure = true, .gain = true};
constexpr milliseconds kFrame{40};

CameraSettings settings(milliseconds exposure = milliseconds(10)) {
  return {.exposure = exposure, .gain = 1.0};
}

/// A frame stamped at that time by a camera that tells all.
DeliveredFrame frame_at(milliseconds time, milliseconds exposure = milliseconds(10)) {
  return {.timestamp = time,
          .duration = kFrame,
          .told = {.exposure = microseconds(exposure), .gain = 1.0},
          .was_asked_before = false};
}

int refused_before(FrameGate& gate, const DeliveredFrame& frame) {
  int refused = 0;
  while (gate.refusal(frame)) ++refused;
  return refused;
}

TEST(FrameGate, RefusesTheFirstFramesOfAStream) {
  FrameGate gate(kAll, false);
  gate.ask(settings());
  gate.start();
  gate.open(milliseconds(1000));
  EXPECT_EQ(refused_before(gate, frame_at(milliseconds(2000))), 2);
}

TEST(FrameGate, RefusesWhatWasExposedBeforeItWasAskedFor) {
  FrameGate gate(kAll, false);
  gate.ask(settings());
  gate.open(milliseconds(1000));
  EXPECT_TRUE(gate.refusal(frame_at(milliseconds(990))));
  EXPECT_TRUE(gate.refusal(frame_at(milliseconds(1030))));
  EXPECT_FALSE(gate.refusal(frame_at(milliseconds(1041))));
}

TEST(FrameGate, AllowsForALongExposure) {
  FrameGate gate(kAll, false);
  gate.ask(settings(milliseconds(500)));
  gate.open(milliseconds(1000));
  EXPECT_TRUE(gate.refusal(frame_at(milliseconds(1400), milliseconds(500))));
  EXPECT_FALSE(gate.refusal(frame_at(milliseconds(1501), milliseconds(500))));
}

TEST(FrameGate, LearnsTheTimeOfAFrameFromTheOneBefore) {
  FrameGate gate(kAll, false);
  gate.ask(settings());
  gate.open(milliseconds(1000));
  DeliveredFrame frame = frame_at(milliseconds(1050));
  frame.duration = nanoseconds(0);
  EXPECT_TRUE(gate.refusal(frame));
  frame.timestamp = milliseconds(1090);
  EXPECT_FALSE(gate.refusal(frame));
}

TEST(FrameGate, CountsFramesThatHaveNoTime) {
  FrameGate gate(kAll, false);
  gate.ask(settings());
  gate.open(milliseconds(1000));
  EXPECT_EQ(refused_before(gate, frame_at(milliseconds(0))), 2);
  EXPECT_FALSE(gate.refusal(frame_at(milliseconds(0))));
  gate.open(milliseconds(2000));
  EXPECT_EQ(refused_before(gate, frame_at(milliseconds(0))), 2);
}

TEST(FrameGate, BelievesTheFirstFrameAfterATrigger) {
  FrameGate gate(kAll, true);
  gate.ask(settings());
  gate.open(milliseconds(1000));
  EXPECT_TRUE(gate.refusal(frame_at(milliseconds(999))));
  EXPECT_FALSE(gate.refusal(frame_at(milliseconds(1001))));
  EXPECT_FALSE(gate.refusal(frame_at(milliseconds(0))));
}

TEST(FrameGate, WaitsForTheSettingsToBeObeyed) {
  FrameGate gate(kAll, false);
  gate.ask(settings());
  gate.open(milliseconds(1000));
  for (int i = 0; i < 50; ++i) {
    EXPECT_TRUE(gate.refusal(frame_at(milliseconds(2000), milliseconds(30))));
  }
  EXPECT_FALSE(gate.refusal(frame_at(milliseconds(2000), milliseconds(10))));
}

TEST(FrameGate, GivesACameraThatDoesNotTellTimeToObey) {
  FrameGate gate(kAll, false);
  gate.ask(settings());
  gate.open(milliseconds(1000));
  DeliveredFrame frame = frame_at(milliseconds(2000));
  frame.told.gain.reset();
  EXPECT_EQ(refused_before(gate, frame), 3);
  // Asked for the same again there is nothing to obey.
  gate.ask(settings());
  EXPECT_EQ(refused_before(gate, frame), 0);
  CameraSettings focused = settings();
  focused.lens_position = 4.0;
  gate.ask(focused);
  EXPECT_EQ(refused_before(gate, frame), 6);
  // A stream that starts anew has to be told everything again.
  gate.start();
  EXPECT_EQ(refused_before(gate, frame), 2 + 6);
}

TEST(FrameGate, DoesNotCountWhatWasAskedForBeforeAsTimeToObey) {
  FrameGate gate(kAll, false);
  gate.ask(settings());
  gate.open(milliseconds(1000));
  DeliveredFrame frame = frame_at(milliseconds(2000));
  frame.told.gain.reset();
  frame.was_asked_before = true;
  for (int i = 0; i < 5; ++i) EXPECT_TRUE(gate.refusal(frame));
  frame.was_asked_before = false;
  EXPECT_EQ(refused_before(gate, frame), 3);
}

TEST(FrameGate, AsksNothingOfACameraWithoutSettings) {
  FrameGate gate({}, false);
  gate.ask(settings());
  gate.open(milliseconds(1000));
  EXPECT_EQ(refused_before(gate, {.timestamp = milliseconds(2000), .duration = kFrame, .told = {}}),
            0);
}

}  // namespace
}  // namespace biotomy::bridge
