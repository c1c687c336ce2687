#include "firmware_bridge/lines/gpio_line_request.hpp"

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <optional>
#include <system_error>

#include "firmware_bridge/device_error.hpp"
#include "firmware_bridge/wire/nearest_name.hpp"

namespace biotomy::bridge {

namespace {

/// What is wrong with one line; the caller puts the line's name before it.
class Unusable : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

std::string in_quotes(const std::string& text) {
  return '"' + text + '"';
}

std::string joined(const std::vector<std::string>& parts) {
  std::string all;
  for (const std::string& part : parts) all += (all.empty() ? "" : ", ") + part;
  return all;
}

bool is_denied(const std::system_error& error) {
  return error.code().value() == EACCES || error.code().value() == EPERM;
}

[[noreturn]] void deny(const std::filesystem::path& device) {
  throw Unusable(device.string() +
                 " is not ours to open: put the daemon's user into the group gpio, and see that "
                 "the udev rule that gives the chips to that group is installed");
}

GpioChipInfo describe(GpioChips& chips, const std::filesystem::path& device) {
  try {
    return chips.describe(device);
  } catch (const std::system_error& error) {
    if (is_denied(error)) deny(device);
    throw Unusable(device.string() + " cannot be opened as a GPIO chip: " + error.code().message());
  }
}

/// All that can be described, and which of the others we may not open.
struct Survey {
  std::vector<GpioChipInfo> chips;
  std::vector<std::filesystem::path> denied;

  explicit Survey(GpioChips& source) {
    for (const std::filesystem::path& device : source.devices()) {
      try {
        chips.push_back(source.describe(device));
      } catch (const std::system_error& error) {
        // One that just goes away is one that is not there.
        if (is_denied(error)) denied.push_back(device);
      }
    }
  }

  std::string text() const {
    std::vector<std::string> parts;
    for (const GpioChipInfo& chip : chips) {
      parts.push_back(chip.name + " (label " + in_quotes(chip.label) + ", " +
                      std::to_string(chip.lines.size()) + " lines)");
    }
    for (const std::filesystem::path& device : denied) {
      parts.push_back(device.filename().string() + " (not ours to open)");
    }
    return parts.empty() ? "this computer has none (no /dev/gpiochip*)"
                         : "there are: " + joined(parts);
  }
};

GpioChipInfo find_chip(GpioChips& source, const std::string& wanted) {
  if (wanted.find('/') != std::string::npos) {
    try {
      return source.describe(wanted);
    } catch (const std::system_error& error) {
      if (error.code().value() != ENOENT) return describe(source, wanted);
      throw Unusable("there is no such file; " + Survey(source).text());
    }
  }
  for (const std::filesystem::path& device : source.devices()) {
    if (device.filename() == wanted) return describe(source, device);
  }
  const Survey survey(source);
  std::vector<GpioChipInfo> labelled;
  std::ranges::copy_if(survey.chips, std::back_inserter(labelled),
                       [&](const GpioChipInfo& chip) { return chip.label == wanted; });
  if (labelled.size() == 1) return labelled.front();
  if (!labelled.empty()) {
    throw Unusable("more than one chip has that label: name one by its path; " + survey.text());
  }
  if (!survey.denied.empty()) deny(survey.denied.front());
  throw Unusable("there is no chip of that path, name or label; " + survey.text());
}

std::optional<unsigned int> number_in(const std::string& text) {
  unsigned int number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return number;
}

unsigned int find_line(const GpioChipInfo& chip, const std::string& wanted) {
  std::vector<std::string> names;
  std::vector<std::string> matches;
  for (std::size_t offset = 0; offset < chip.lines.size(); ++offset) {
    const std::string& name = chip.lines[offset].name;
    if (!name.empty()) names.push_back(name);
    if (!name.empty() && name == wanted) matches.push_back(std::to_string(offset));
  }
  if (matches.size() > 1) {
    throw Unusable("more than one line has that name: give its offset, one of " + joined(matches));
  }
  const std::optional<unsigned int> offset = number_in(matches.empty() ? wanted : matches.front());
  if (offset && *offset < chip.lines.size()) return *offset;

  const std::string nearest = nearest_name(wanted, names);
  throw Unusable("the chip has no line of that name or offset" +
                 (nearest.empty() ? "" : "; did you mean " + in_quotes(nearest) + "?") +
                 (chip.lines.empty()
                      ? "; it has none at all"
                      : "; its offsets are 0 to " + std::to_string(chip.lines.size() - 1) + ", " +
                            std::to_string(names.size()) + " of its lines have names"));
}

const char* to_string(LineBias bias) {
  switch (bias) {
    case LineBias::as_is:
      return "as-is";
    case LineBias::disabled:
      return "disabled";
    case LineBias::pull_up:
      return "pull-up";
    case LineBias::pull_down:
      return "pull-down";
  }
  return "unknown";
}

std::string holder_of(GpioChips& chips, const GpioRequest& request) {
  try {
    const GpioLineInfo line = chips.describe(request.device).lines.at(request.offset);
    if (line.consumer == kGpioConsumer) {
      return in_quotes(line.consumer) + ": another daemon, or another of the roles in [lines]";
    }
    if (!line.consumer.empty()) return in_quotes(line.consumer);
  } catch (const std::exception&) {
    // Who held it has gone meanwhile, or the whole chip has.
  }
  return "somebody without a name";
}

/// Why the kernel refused a line that is there.
std::string reason(GpioChips& chips, const GpioRequest& request, const std::system_error& error) {
  const std::string cause = error.code().message();
  switch (error.code().value()) {
    case EBUSY:
      return "is held by " + holder_of(chips, request) + "; release it there or choose another";
    case ENXIO:
    case ENODEV:
      if (!request.edges) break;
      return "has no edge events (" + cause +
             "): the chip has no interrupts for it, or went away; choose another line, or set "
             "edges = false and lose pulses shorter than a tick";
    case EINVAL:
    case EOPNOTSUPP:
      if (request.bias == LineBias::as_is) break;
      return std::string("the kernel cannot set its bias ") + to_string(request.bias) + " (" +
             cause + "): set bias = \"as-is\" and wire a resistor";
    default:
      break;
  }
  return "cannot be had: " + cause;
}

}  // namespace

template <class Ask>
auto GpioLineRequest::request(bool edges, Ask ask) {
  try {
    const GpioChipInfo chip = find_chip(*chips_, settings_.chip);
    if (label_ && chip.label != *label_) {
      throw Unusable("this is another chip now, with the label " + in_quotes(chip.label) +
                     " in place of " + in_quotes(*label_) +
                     "; name the chip by its label, since numbers change");
    }
    const GpioRequest line{.device = chip.device,
                           .offset = find_line(chip, settings_.line),
                           .active_low = settings_.active_low,
                           .bias = settings_.bias,
                           .edges = edges};
    try {
      auto held = ask(line);
      label_ = chip.label;
      return held;
    } catch (const std::system_error& error) {
      throw Unusable(reason(*chips_, line, error));
    }
  } catch (const Unusable& error) {
    throw DeviceError(
        DeviceError::Kind::configuration,
        "line " + settings_.line + " of GPIO chip " + settings_.chip + ": " + error.what());
  }
}

std::unique_ptr<GpioInput> GpioLineRequest::input() {
  return request(settings_.edges,
                 [this](const GpioRequest& line) { return chips_->request_input(line); });
}

std::unique_ptr<GpioOutput> GpioLineRequest::output() {
  return request(false, [this](const GpioRequest& line) { return chips_->request_output(line); });
}

}  // namespace biotomy::bridge
