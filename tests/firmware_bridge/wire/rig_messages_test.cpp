#include "firmware_bridge/wire/rig_messages.hpp"

#include <limits>

#include <gtest/gtest.h>

namespace biotomy::bridge {
namespace {

TEST(RigMessages, ComeBackFromTheirOwnJson) {
  const std::vector<RigMessage> messages = {
      HelloMessage{.service = RigService::lines},
      WelcomeMessage{},
      WelcomeMessage{.camera = WelcomeMessage::Camera{"a camera", 640, 480}},
      WelcomeMessage{.camera = WelcomeMessage::Camera{"a camera", 640, 480, Transfer::linear}},
      ConfigureMessage{.exposure_us = 1500.5, .gain = 2, .red_gain = 1.5, .blue_gain = 0.75},
      ConfiguredMessage{},
      CaptureMessage{},
      FrameMessage{.width = 4,
                   .height = 3,
                   .stride = 24,
                   .format = RigPixelFormat::rgb161616,
                   .sequence = UINT64_MAX,
                   .timestamp_ns = INT64_MAX,
                   .exposure_us = 10,
                   .gain = 1},
      ReadInputsMessage{},
      InputsMessage{.estop_pressed = false, .door_open = true},
      SetOutputMessage{.role = RigOutput::tower_light, .on = true},
      OutputSetMessage{},
      SetInputMessage{.input = RigInput::door, .on = true},
      InputSetMessage{},
      BeginFaultMessage{.name = "lamp", .event = "fault = \"lamp_dead\"\n"},
      FaultBegunMessage{},
      EndFaultMessage{.name = "lamp"},
      FaultEndedMessage{},
      ErrorMessage{"no"}};
  for (const RigMessage& message : messages) {
    const std::string text = to_json(message);
    EXPECT_EQ(to_json(from_json(text)), text);
    EXPECT_EQ(from_json(text).index(), message.index());
  }
}

TEST(RigMessages, ReadTheExamplesOfTheProtocol) {
  const auto frame = std::get<FrameMessage>(from_json(
      R"({"type":"frame","width":2,"height":1,"stride":6,"format":"RGB888","sequence":7,
          "timestamp_ns":8,"exposure_us":100,"gain":1.5})"));
  EXPECT_EQ(frame.width, 2);
  EXPECT_EQ(frame.stride, 6);
  EXPECT_EQ(frame.sequence, 7U);
  EXPECT_EQ(frame.gain, 1.5);
  const auto hello =
      std::get<HelloMessage>(from_json(R"({"type":"hello","protocol":1,"service":"camera"})"));
  EXPECT_EQ(hello.service, RigService::camera);
  const auto transfer_of = [](const std::string& fields) {
    return std::get<WelcomeMessage>(
               from_json(R"({"type":"welcome","protocol":1,"model":"m","width":2,"height":1)" +
                         fields + "}"))
        .camera->transfer;
  };
  EXPECT_EQ(transfer_of(""), Transfer::srgb) << "of a camera that doesn't tell";
  EXPECT_EQ(transfer_of(R"(,"transfer":"linear")"), Transfer::linear);
}

TEST(RigMessages, RefuseWhatIsNoMessage) {
  for (const char* text :
       {"", "{", "null", "[]", "7", "{}", R"({"type":1})", R"({"type":"dance"})",
        R"({"type":"capture","extra":1})", R"({"type":"set_output","role":"lamp"})",
        R"({"type":"set_output","role":"horn","on":true})",
        R"({"type":"set_output","role":"lamp","on":1})",
        R"({"type":"inputs","estop_pressed":null,"door_open":false})",
        R"({"type":"hello","protocol":1.5,"service":"camera"})",
        R"({"type":"hello","protocol":1,"service":"camera"}x)",
        R"({"type":"welcome","protocol":1,"model":"m","width":0,"height":1})",
        R"({"type":"welcome","protocol":1,"model":"m","width":2,"height":1,"transfer":"log"})",
        R"({"type":"welcome","protocol":1,"model":"m"})"}) {
    EXPECT_THROW(from_json(text), MessageError) << text;
  }
}

TEST(RigMessages, RefuseFramesThatCannotBe) {
  const auto frame = [](const std::string& sizes) {
    return from_json(R"({"type":"frame","format":"RGB888","sequence":7,"timestamp_ns":8,)"
                     R"("exposure_us":100,"gain":1,)" +
                     sizes + "}");
  };
  EXPECT_NO_THROW(frame(R"("width":10,"height":10,"stride":30)"));
  EXPECT_THROW(frame(R"("width":10,"height":10,"stride":29)"), MessageError);
  EXPECT_THROW(frame(R"("width":-1,"height":10,"stride":30)"), MessageError);
  EXPECT_THROW(frame(R"("width":65536,"height":10,"stride":300000)"), MessageError);
  EXPECT_THROW(frame(R"("width":10,"height":18446744073709551615,"stride":30)"), MessageError);
  EXPECT_THROW(frame(R"("width":10,"height":10,"stride":1e9)"), MessageError);
}

TEST(RigMessages, RefuseToWriteWhatJsonCannotHold) {
  EXPECT_THROW(to_json(ConfigureMessage{.gain = std::numeric_limits<double>::quiet_NaN()}),
               MessageError);
}

TEST(RigMessages, WriteAnErrorOfAnyBytes) {
  const RigMessage read = from_json(to_json(ErrorMessage{"bad \xFF byte\n\"quoted\""}));
  EXPECT_NE(std::get<ErrorMessage>(read).message.find("\"quoted\""), std::string::npos);
}

}  // namespace
}  // namespace biotomy::bridge
