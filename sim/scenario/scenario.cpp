#include "sim/scenario/scenario.hpp"

#include <array>
#include <cmath>
#include <utility>

#include "sim/scenario/fault_reader.hpp"

namespace biotomy::sim {

namespace {

using bridge::CheckedTable;
using bridge::IntegerKey;
using bridge::NumberKey;
using bridge::TextKey;

constexpr double kLongest = 1e9;  // seconds, layers, photographs: beyond any run
constexpr int kMostTimes = 1000000;

double number(const CheckedTable& table, const char* name, double fallback, double least,
              double most, const char* unit, const char* description) {
  return table.get(NumberKey{.name = name,
                             .fallback = fallback,
                             .unit = unit,
                             .minimum = least,
                             .maximum = most,
                             .description = description});
}

constexpr std::array kMoments{
    std::pair{Occasion::Moment::rig_time, "rig_seconds"},
    std::pair{Occasion::Moment::grind_started, "grind_started"},
    std::pair{Occasion::Moment::grind_finished, "grind_finished"},
    std::pair{Occasion::Moment::capture, "capture"},
};

Occasion read_occasion(const CheckedTable& when) {
  Occasion occasion;
  const char* chosen = nullptr;
  for (const auto& [moment, key] : kMoments) {
    const bool is_time = moment == Occasion::Moment::rig_time;
    const double at = number(when, key, is_time ? 0 : 1, is_time ? 0 : 1, kLongest,
                             is_time ? "s" : "", "the moment");
    if (!when.has(key)) continue;
    if (chosen != nullptr) {
      when.reject(key, std::string("an event has one moment, and ") + chosen + " is given already");
    }
    if (!is_time && at != std::floor(at)) when.reject(key, "expected a whole number");
    chosen = key;
    occasion.moment = moment;
    occasion.at = at;
  }
  occasion.every = number(when, "every", 0, 0, kLongest, "",
                          "again after so many seconds, layers or photographs; 0: once");
  if (occasion.moment != Occasion::Moment::rig_time &&
      occasion.every != std::floor(occasion.every)) {
    when.reject("every", "expected a whole number of layers or photographs");
  }
  occasion.delay_s = number(when, "delay", 0, 0, kLongest, "s", "rig time after the moment");
  occasion.probability = number(when, "probability", 1, 0, 1, "", "that it happens at all");
  return occasion;
}

Duration read_duration(const CheckedTable& lasts) {
  Duration duration;
  int given = 0;
  const auto seconds = [&](const char* name, const char* description) -> std::optional<double> {
    const double value = number(lasts, name, 1, 0.001, kLongest, "s", description);
    if (!lasts.has(name)) return std::nullopt;
    if (++given > 1) lasts.reject(name, "an event lasts by one measure alone");
    return value;
  };
  const auto times = [&](const char* name, const char* description) -> std::optional<int> {
    const auto value = lasts.get(IntegerKey{.name = name,
                                            .fallback = 1,
                                            .minimum = 1,
                                            .maximum = kMostTimes,
                                            .description = description});
    if (!lasts.has(name)) return std::nullopt;
    if (++given > 1) lasts.reject(name, "an event lasts by one measure alone");
    return static_cast<int>(value);
  };
  duration.rig_seconds = seconds("rig_seconds", "of the rig's time");
  duration.real_seconds = seconds("real_seconds", "of real time");
  duration.captures = times("captures", "photographs that are asked for");
  duration.grinds = times("grinds", "grind passes that end");
  lasts.get(TextKey{.name = "until",
                    .fallback = "reset",
                    .choices = {"reset"},
                    .description = "the controller is reset"});
  duration.until_reset = lasts.has("until");
  if (duration.until_reset && ++given > 1) {
    lasts.reject("until", "an event lasts by one measure alone");
  }
  return duration;
}

ScenarioEvent read_event(const std::string& name, const CheckedTable& event) {
  return {name, read_fault(event), read_occasion(event.table("when")),
          read_duration(event.table("lasts"))};
}

}  // namespace

Scenario read_scenario(const CheckedTable& file) {
  Scenario scenario;
  scenario.about = file.get(TextKey{.name = "about", .description = "what happens, in a sentence"});
  for (const auto& [name, event] : file.table("events").named_tables()) {
    scenario.events.push_back(read_event(name, event));
  }
  file.refuse_unknown_keys();
  if (scenario.events.empty()) {
    file.reject("events", "missing; a scenario needs an event, [events.NAME] with its fault");
  }
  return scenario;
}

ScenarioEvent parse_event(const std::string& name, std::string_view text) {
  const CheckedTable table = CheckedTable::parse(text, "fault " + name);
  ScenarioEvent event = read_event(name, table);
  table.refuse_unknown_keys();
  return event;
}

}  // namespace biotomy::sim
