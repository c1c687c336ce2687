#pragma once

#include <cstdint>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <variant>

#include "firmware_bridge/wire/transfer.hpp"

namespace biotomy::bridge {

// The messages of README.md, one struct each.

inline constexpr int kRigProtocol = 1;

/// A packet that is no message of this protocol: not JSON, an unknown type, a field missing, of the
/// wrong type, out of range, or unknown.
class MessageError : public std::runtime_error {
 public:
  explicit MessageError(const std::string& message) : std::runtime_error(message) {}
};

enum class RigService { camera, lines, bench };
enum class RigOutput { lamp, trigger, tower_light };
enum class RigInput { estop, door };
enum class RigPixelFormat { rgb888, rgb161616 };

struct HelloMessage {
  int protocol = kRigProtocol;
  RigService service = RigService::camera;
};

/// Only the service `camera` says what it is.
struct WelcomeMessage {
  struct Camera {
    std::string model;
    int width = 0;
    int height = 0;
    Transfer transfer = Transfer::srgb;  ///< of one that doesn't tell, too
  };
  int protocol = kRigProtocol;
  std::optional<Camera> camera{};
};

struct ConfigureMessage {
  double exposure_us = 0.0;
  double gain = 1.0;
  double red_gain = 1.0;
  double blue_gain = 1.0;
};
struct ConfiguredMessage {};

struct CaptureMessage {};

/// Goes with a sealed memfd of `stride` × `height` bytes (shared_frame).
struct FrameMessage {
  int width = 0;   ///< pixels, 1 to 65535
  int height = 0;  ///< rows, 1 to 65535
  int stride = 0;  ///< bytes a row, at least width × bytes_per_pixel(format)
  RigPixelFormat format = RigPixelFormat::rgb888;
  std::uint64_t sequence = 0;
  std::int64_t timestamp_ns = 0;
  double exposure_us = 0.0;
  double gain = 0.0;
};

struct ReadInputsMessage {};
struct InputsMessage {
  bool estop_pressed = true;
  bool door_open = true;
};

struct SetOutputMessage {
  RigOutput role = RigOutput::lamp;
  bool on = false;
};
struct OutputSetMessage {};

/// Of the service `bench`, which a twin has and a rig has not: presses its e-stop, opens its door.
struct SetInputMessage {
  RigInput input = RigInput::estop;
  bool on = false;
};
struct InputSetMessage {};

/// Of the bench, too: something breaks. `event` is TOML text, as in a table of a scenario's file
/// (sim/README.md); a fault of the same name is replaced.
struct BeginFaultMessage {
  std::string name;
  std::string event;
};
struct FaultBegunMessage {};

/// The fault of this name is mended.
struct EndFaultMessage {
  std::string name;
};
struct FaultEndedMessage {};

struct ErrorMessage {
  std::string message;
};

using RigMessage =
    std::variant<HelloMessage, WelcomeMessage, ConfigureMessage, ConfiguredMessage, CaptureMessage,
                 FrameMessage, ReadInputsMessage, InputsMessage, SetOutputMessage, OutputSetMessage,
                 SetInputMessage, InputSetMessage, BeginFaultMessage, FaultBegunMessage,
                 EndFaultMessage, FaultEndedMessage, ErrorMessage>;

/// The packet's text. Throws MessageError for a number that JSON cannot hold (NaN, infinity).
std::string to_json(const RigMessage& message);

/// The message in a packet's text; strict, and bounded by the packet's size. Throws MessageError.
RigMessage from_json(std::string_view text);

/// The message's "type", for messages to people.
std::string type_of(const RigMessage& message);

int bytes_per_pixel(RigPixelFormat format);

}  // namespace biotomy::bridge
