#include "firmware_bridge/wire/rig_messages.hpp"

#include <array>
#include <cmath>
#include <set>
#include <utility>

#include <nlohmann/json.hpp>

namespace biotomy::bridge {

namespace {

using nlohmann::json;

constexpr int kLargestSide = 65535;

// The words of the protocol, once for both directions.
constexpr std::array kServices{std::pair{RigService::camera, "camera"},
                               std::pair{RigService::lines, "lines"},
                               std::pair{RigService::bench, "bench"}};
constexpr std::array kOutputs{std::pair{RigOutput::lamp, "lamp"},
                              std::pair{RigOutput::trigger, "trigger"},
                              std::pair{RigOutput::tower_light, "tower_light"}};
constexpr std::array kInputs{std::pair{RigInput::estop, "estop"},
                             std::pair{RigInput::door, "door"}};
constexpr std::array kPixelFormats{std::pair{RigPixelFormat::rgb888, "RGB888"},
                                   std::pair{RigPixelFormat::rgb161616, "RGB161616"}};
constexpr std::array kTransfers{std::pair{Transfer::srgb, "srgb"},
                                std::pair{Transfer::linear, "linear"}};

template <class Words, class Value>
const char* word_for(const Words& words, Value value) {
  for (const auto& [known, word] : words) {
    if (known == value) return word;
  }
  throw MessageError("rig message: a value without a word");
}

/// The fields of one message, each to be taken once; what is left over is an error.
class Fields {
 public:
  Fields(const json& object, std::string type) : object_(object), type_(std::move(type)) {
    taken_.insert("type");
  }

  bool has(const char* name) const { return object_.contains(name); }

  bool flag(const char* name) {
    const json& field = take(name);
    if (!field.is_boolean()) refuse(name, "expected true or false");
    return field.get<bool>();
  }

  std::string text(const char* name) {
    const json& field = take(name);
    if (!field.is_string()) refuse(name, "expected a text");
    return field.get<std::string>();
  }

  double number(const char* name, double minimum, double maximum) {
    const json& field = take(name);
    if (!field.is_number()) refuse(name, "expected a number");
    const double value = field.get<double>();
    if (!(value >= minimum && value <= maximum)) refuse(name, "is out of range");
    return value;
  }

  template <class Integer>
  Integer integer(const char* name, Integer minimum, Integer maximum) {
    const json& field = take(name);
    if (!field.is_number_integer()) refuse(name, "expected an integer");
    // A JSON integer is unsigned unless it is negative: compared as it is stored, nothing wraps.
    const bool fits = field.is_number_unsigned()
                          ? std::cmp_greater_equal(field.get<std::uint64_t>(), minimum) &&
                                std::cmp_less_equal(field.get<std::uint64_t>(), maximum)
                          : std::cmp_greater_equal(field.get<std::int64_t>(), minimum) &&
                                std::cmp_less_equal(field.get<std::int64_t>(), maximum);
    if (!fits) refuse(name, "is out of range");
    return field.get<Integer>();
  }

  template <class Words>
  auto word(const char* name, const Words& words) {
    const std::string given = text(name);
    for (const auto& [value, word] : words) {
      if (given == word) return value;
    }
    refuse(name, "is none of the words it may be");
  }

  void end() const {
    for (const auto& [name, value] : object_.items()) {
      if (!taken_.contains(name)) {
        throw MessageError("rig message " + type_ + ": it has a field that it must not have");
      }
    }
  }

 private:
  const json& take(const char* name) {
    taken_.insert(name);
    const auto found = object_.find(name);
    if (found == object_.end()) refuse(name, "is missing");
    return *found;
  }

  [[noreturn]] void refuse(const char* name, const std::string& what) const {
    throw MessageError("rig message " + type_ + ": " + name + ": " + what);
  }

  const json& object_;
  std::string type_;
  std::set<std::string> taken_;
};

constexpr double kLongestExposure = 1e12;  // µs; more than a week is no exposure
constexpr double kHighestGain = 1e6;

// One Codec for each message: its word, its fields out, its fields in.
template <class Message>
struct Codec;

/// A message without fields.
template <class Message>
struct EmptyCodec {
  static void write(json&, const Message&) {}
  static Message read(Fields&) { return {}; }
};

template <>
struct Codec<HelloMessage> {
  static constexpr const char* kType = "hello";
  static void write(json& object, const HelloMessage& message) {
    object["protocol"] = message.protocol;
    object["service"] = word_for(kServices, message.service);
  }
  static HelloMessage read(Fields& fields) {
    return {.protocol = fields.integer("protocol", 0, kLargestSide),
            .service = fields.word("service", kServices)};
  }
};

template <>
struct Codec<WelcomeMessage> {
  static constexpr const char* kType = "welcome";
  static void write(json& object, const WelcomeMessage& message) {
    object["protocol"] = message.protocol;
    if (!message.camera) return;
    object["model"] = message.camera->model;
    object["width"] = message.camera->width;
    object["height"] = message.camera->height;
    object["transfer"] = word_for(kTransfers, message.camera->transfer);
  }
  static WelcomeMessage read(Fields& fields) {
    WelcomeMessage message{.protocol = fields.integer("protocol", 0, kLargestSide)};
    if (fields.has("model")) {
      message.camera = {.model = fields.text("model"),
                        .width = fields.integer("width", 1, kLargestSide),
                        .height = fields.integer("height", 1, kLargestSide)};
      if (fields.has("transfer")) message.camera->transfer = fields.word("transfer", kTransfers);
    }
    return message;
  }
};

template <>
struct Codec<ConfigureMessage> {
  static constexpr const char* kType = "configure";
  static void write(json& object, const ConfigureMessage& message) {
    object["exposure_us"] = message.exposure_us;
    object["gain"] = message.gain;
    object["red_gain"] = message.red_gain;
    object["blue_gain"] = message.blue_gain;
  }
  static ConfigureMessage read(Fields& fields) {
    return {.exposure_us = fields.number("exposure_us", 0, kLongestExposure),
            .gain = fields.number("gain", 0, kHighestGain),
            .red_gain = fields.number("red_gain", 0, kHighestGain),
            .blue_gain = fields.number("blue_gain", 0, kHighestGain)};
  }
};

template <>
struct Codec<FrameMessage> {
  static constexpr const char* kType = "frame";
  static void write(json& object, const FrameMessage& message) {
    object["width"] = message.width;
    object["height"] = message.height;
    object["stride"] = message.stride;
    object["format"] = word_for(kPixelFormats, message.format);
    object["sequence"] = message.sequence;
    object["timestamp_ns"] = message.timestamp_ns;
    object["exposure_us"] = message.exposure_us;
    object["gain"] = message.gain;
  }
  static FrameMessage read(Fields& fields) {
    FrameMessage message;
    message.width = fields.integer("width", 1, kLargestSide);
    message.height = fields.integer("height", 1, kLargestSide);
    message.format = fields.word("format", kPixelFormats);
    message.stride = fields.integer("stride", message.width * bytes_per_pixel(message.format),
                                    16 * kLargestSide);
    message.sequence = fields.integer<std::uint64_t>("sequence", 0, UINT64_MAX);
    message.timestamp_ns = fields.integer<std::int64_t>("timestamp_ns", 0, INT64_MAX);
    message.exposure_us = fields.number("exposure_us", 0, kLongestExposure);
    message.gain = fields.number("gain", 0, kHighestGain);
    return message;
  }
};

template <>
struct Codec<InputsMessage> {
  static constexpr const char* kType = "inputs";
  static void write(json& object, const InputsMessage& message) {
    object["estop_pressed"] = message.estop_pressed;
    object["door_open"] = message.door_open;
  }
  static InputsMessage read(Fields& fields) {
    return {.estop_pressed = fields.flag("estop_pressed"), .door_open = fields.flag("door_open")};
  }
};

template <>
struct Codec<SetOutputMessage> {
  static constexpr const char* kType = "set_output";
  static void write(json& object, const SetOutputMessage& message) {
    object["role"] = word_for(kOutputs, message.role);
    object["on"] = message.on;
  }
  static SetOutputMessage read(Fields& fields) {
    return {.role = fields.word("role", kOutputs), .on = fields.flag("on")};
  }
};

template <>
struct Codec<SetInputMessage> {
  static constexpr const char* kType = "set_input";
  static void write(json& object, const SetInputMessage& message) {
    object["input"] = word_for(kInputs, message.input);
    object["on"] = message.on;
  }
  static SetInputMessage read(Fields& fields) {
    return {.input = fields.word("input", kInputs), .on = fields.flag("on")};
  }
};

template <>
struct Codec<BeginFaultMessage> {
  static constexpr const char* kType = "begin_fault";
  static void write(json& object, const BeginFaultMessage& message) {
    object["name"] = message.name;
    object["event"] = message.event;
  }
  static BeginFaultMessage read(Fields& fields) {
    return {.name = fields.text("name"), .event = fields.text("event")};
  }
};

template <>
struct Codec<EndFaultMessage> {
  static constexpr const char* kType = "end_fault";
  static void write(json& object, const EndFaultMessage& message) { object["name"] = message.name; }
  static EndFaultMessage read(Fields& fields) { return {.name = fields.text("name")}; }
};

template <>
struct Codec<ErrorMessage> {
  static constexpr const char* kType = "error";
  static void write(json& object, const ErrorMessage& message) {
    object["message"] = message.message;
  }
  static ErrorMessage read(Fields& fields) { return {.message = fields.text("message")}; }
};

template <>
struct Codec<ConfiguredMessage> : EmptyCodec<ConfiguredMessage> {
  static constexpr const char* kType = "configured";
};
template <>
struct Codec<CaptureMessage> : EmptyCodec<CaptureMessage> {
  static constexpr const char* kType = "capture";
};
template <>
struct Codec<ReadInputsMessage> : EmptyCodec<ReadInputsMessage> {
  static constexpr const char* kType = "read_inputs";
};
template <>
struct Codec<OutputSetMessage> : EmptyCodec<OutputSetMessage> {
  static constexpr const char* kType = "output_set";
};
template <>
struct Codec<InputSetMessage> : EmptyCodec<InputSetMessage> {
  static constexpr const char* kType = "input_set";
};
template <>
struct Codec<FaultBegunMessage> : EmptyCodec<FaultBegunMessage> {
  static constexpr const char* kType = "fault_begun";
};
template <>
struct Codec<FaultEndedMessage> : EmptyCodec<FaultEndedMessage> {
  static constexpr const char* kType = "fault_ended";
};

void check_numbers(const json& object) {
  for (const auto& [name, value] : object.items()) {
    if (value.is_number_float() && !std::isfinite(value.get<double>())) {
      throw MessageError("rig message: " + name + " is not a finite number");
    }
  }
}

/// Goes through the alternatives of RigMessage until one has the type's word.
template <std::size_t I = 0>
RigMessage read_message(const json& object, const std::string& type) {
  if constexpr (I == std::variant_size_v<RigMessage>) {
    throw MessageError("rig message: unknown type \"" + type.substr(0, 40) + "\"");
  } else {
    using Message = std::variant_alternative_t<I, RigMessage>;
    if (type != Codec<Message>::kType) return read_message<I + 1>(object, type);
    Fields fields(object, type);
    RigMessage message = Codec<Message>::read(fields);
    fields.end();
    return message;
  }
}

}  // namespace

std::string to_json(const RigMessage& message) {
  json object;
  object["type"] = type_of(message);
  std::visit([&](const auto& held) { Codec<std::decay_t<decltype(held)>>::write(object, held); },
             message);
  check_numbers(object);
  // A message from elsewhere (an exception's text) may hold any bytes; JSON may not.
  return object.dump(-1, ' ', false, json::error_handler_t::replace);
}

RigMessage from_json(std::string_view text) {
  const json object = json::parse(text, nullptr, false);
  if (!object.is_object()) throw MessageError("rig message: not a JSON object");
  const auto type = object.find("type");
  if (type == object.end() || !type->is_string()) throw MessageError("rig message: it has no type");
  return read_message(object, type->get<std::string>());
}

std::string type_of(const RigMessage& message) {
  return std::visit(
      [](const auto& held) -> std::string { return Codec<std::decay_t<decltype(held)>>::kType; },
      message);
}

int bytes_per_pixel(RigPixelFormat format) {
  return format == RigPixelFormat::rgb888 ? 3 : 6;
}

}  // namespace biotomy::bridge
