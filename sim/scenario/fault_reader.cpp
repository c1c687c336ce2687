#include "sim/scenario/fault_reader.hpp"

#include <array>
#include <cstddef>
#include <utility>
#include <vector>

#include "firmware_bridge/wire/nearest_name.hpp"

namespace biotomy::sim {

namespace {

using bridge::CheckedTable;
using bridge::IntegerKey;
using bridge::NumberKey;
using bridge::TextKey;

/// A number whose default is the one that the fault's type has.
double number(const CheckedTable& event, const char* name, double fallback, const char* unit,
              double least, double most, const char* description) {
  return event.get(NumberKey{.name = name,
                             .fallback = fallback,
                             .unit = unit,
                             .minimum = least,
                             .maximum = most,
                             .description = description});
}

MachineAxis read_axis(const CheckedTable& event) {
  const std::string name = event.get(TextKey{.name = "axis",
                                             .fallback = "feed",
                                             .choices = {"feed", "traverse", "column"},
                                             .description = "which axis"});
  return name == "feed"       ? MachineAxis::feed
         : name == "traverse" ? MachineAxis::traverse
                              : MachineAxis::column;
}

// The parameters of each fault that has some.

template <class Fault>
void read_parameters(const CheckedTable&, Fault&) {}

void read_parameters(const CheckedTable& event, DoorBounces& fault) {
  fault.period_s =
      number(event, "period", fault.period_s, "s", 0.01, 3600, "rig time between two openings");
  fault.open_s = number(event, "open", fault.open_s, "s", 0.004, 3600, "rig time it is open");
  if (fault.open_s >= fault.period_s) {
    event.reject("open", "must be less than period; or use the fault door_open");
  }
}

void read_parameters(const CheckedTable& event, LampDims& fault) {
  fault.share = number(event, "share", fault.share, "", 0, 1, "of the light that is left");
}

void read_parameters(const CheckedTable& event, LampFlickers& fault) {
  fault.share = number(event, "share", fault.share, "", 0, 1, "of the light left at the darkest");
  fault.frequency_hz = number(event, "frequency", fault.frequency_hz, "Hz", 0.001, 1000, "of it");
}

void read_parameters(const CheckedTable& event, LampLightsUnevenly& fault) {
  const auto slope = [&](const char* name, double fallback, const char* description) {
    return number(event, name, fallback, "", -1, 1, description);
  };
  fault.slope_x = slope("slope_x", fault.slope_x,
                        "of the mean light: so much more falls on the right edge than the left");
  fault.slope_y = slope("slope_y", fault.slope_y, "likewise on the lower edge than the upper");
}

void read_parameters(const CheckedTable& event, LampChangesColour& fault) {
  const auto factor = [&](const char* name, double fallback) {
    return number(event, name, fallback, "", 0, 2, "factor of its light");
  };
  fault.red = factor("red", fault.red);
  fault.green = factor("green", fault.green);
  fault.blue = factor("blue", fault.blue);
}

void read_parameters(const CheckedTable& event, FaceFrosts& fault) {
  fault.share = number(event, "share", fault.share, "", 0, 1, "of the frame that it covers");
  fault.opacity = number(event, "opacity", fault.opacity, "", 0, 1, "1 hides what is under it");
}

void read_parameters(const CheckedTable& event, FaceGlares& fault) {
  fault.share = number(event, "share", fault.share, "", 0, 0.1, "of the frame that shines");
}

void read_parameters(const CheckedTable& event, BlockShifts& fault) {
  fault.x_um = number(event, "x", fault.x_um, "um", -1e6, 1e6, "to the right");
  fault.y_um = number(event, "y", fault.y_um, "um", -1e6, 1e6, "down");
}

void read_parameters(const CheckedTable& event, CameraGivesOldFrame& fault) {
  fault.under_old_number =
      event.get(TextKey{.name = "number",
                        .fallback = "new",
                        .choices = {"new", "old"},
                        .description = "and time under which it comes"}) == "old";
}

void read_parameters(const CheckedTable& event, CameraTearsFrame& fault) {
  fault.share = number(event, "share", fault.share, "", 0, 1, "of the rows that are new");
}

void read_parameters(const CheckedTable& event, CameraGivesWrongSize& fault) {
  const auto side = [&](const char* name, int fallback) {
    return static_cast<int>(event.get(IntegerKey{.name = name,
                                                 .fallback = fallback,
                                                 .unit = "px",
                                                 .minimum = 1,
                                                 .maximum = 16384,
                                                 .description = "of the frame"}));
  };
  fault.width = side("width", fault.width);
  fault.height = side("height", fault.height);
}

void read_parameters(const CheckedTable& event, AxisStalls& fault) {
  fault.axis = read_axis(event);
}

void read_parameters(const CheckedTable& event, AxisCreeps& fault) {
  fault.axis = read_axis(event);
  fault.speed_um_s = number(event, "speed", fault.speed_um_s, "um/s", -1e6, 1e6, "of it, signed");
}

void read_parameters(const CheckedTable& event, AxisReadsWrong& fault) {
  fault.axis = read_axis(event);
  fault.error_um =
      number(event, "error", fault.error_um, "um", -1e6, 1e6, "shown more than is true");
}

void read_parameters(const CheckedTable& event, SpindleOverloaded& fault) {
  fault.load_percent = number(event, "load", fault.load_percent, "%", 0, 1000,
                              "of the rated torque, beside what the cut takes");
}

void read_parameters(const CheckedTable& event, GrindRemovesTooLittle& fault) {
  fault.short_um = number(event, "short", fault.short_um, "um", 0, 1e6,
                          "the wheel reaches so much less deep than the feed says");
}

void read_parameters(const CheckedTable& event, VibrationFromOutside& fault) {
  fault.velocity_mm_s =
      number(event, "velocity", fault.velocity_mm_s, "mm/s", 0, 1000, "RMS, of the whole rig");
}

void read_parameters(const CheckedTable& event, CoolerFails& fault) {
  fault.time_constant_s = number(event, "time_constant", fault.time_constant_s, "s", 1, 1e6,
                                 "with which the chamber warms");
}

template <class Fault>
RigFault read_one(const CheckedTable& event) {
  Fault fault;
  read_parameters(event, fault);
  return fault;
}

struct KnownFault {
  const char* name;
  const char* meaning;
  RigFault (*read)(const CheckedTable&);
};

template <std::size_t... I>
constexpr auto make_known_faults(std::index_sequence<I...>) {
  return std::array{KnownFault{std::variant_alternative_t<I, RigFault>::kName,
                               std::variant_alternative_t<I, RigFault>::kMeaning,
                               &read_one<std::variant_alternative_t<I, RigFault>>}...};
}

constexpr auto kKnownFaults =
    make_known_faults(std::make_index_sequence<std::variant_size_v<RigFault>>());

}  // namespace

const char* name_of(const RigFault& fault) {
  return kKnownFaults[fault.index()].name;
}

RigFault read_fault(const CheckedTable& event) {
  const std::string name = event.get(TextKey{.name = "fault", .description = "what breaks"});
  std::vector<std::string> names;
  for (const KnownFault& known : kKnownFaults) {
    if (name == known.name) {
      return known.read(event);
    }
    names.emplace_back(known.name);
  }
  const std::string nearest = bridge::nearest_name(name, names);
  event.reject("fault", "\"" + name + "\" is no fault that the rig can have; " +
                            (nearest.empty() ? "sim/README.md lists them"
                                             : "did you mean \"" + nearest + "\"?"));
}

std::string fault_reference() {
  const CheckedTable file = CheckedTable::for_reference();
  std::string text =
      "| what breaks | parameter | default | unit | allowed | meaning |\n"
      "| --- | --- | --- | --- | --- | --- |\n";
  for (const KnownFault& known : kKnownFaults) {
    known.read(file.table(known.name));
    text.append("| `").append(known.name).append("` | | | | | ");
    text.append(known.meaning).append(" |\n");
    for (const bridge::DeclaredKey& key : file.declared_keys()) {
      if (key.table != known.name) continue;
      text.append("| | `").append(key.name).append("` | `").append(key.default_value);
      text.append("` | ").append(key.unit).append(" | ").append(key.allowed).append(" | ");
      text.append(key.description).append(" |\n");
    }
  }
  return text;
}

}  // namespace biotomy::sim
