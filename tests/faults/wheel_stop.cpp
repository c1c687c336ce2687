#include "tests/faults/wheel_stop.hpp"

#include <algorithm>
#include <cstdio>
#include <ctime>
#include <stdexcept>

#include <nlohmann/json.hpp>

#include "tests/integration/witness_lines.hpp"

namespace biotomy::tests {

namespace {

using std::chrono::milliseconds;

/// Since the epoch, of ISO 8601 in UTC with milliseconds.
milliseconds moment(const std::string& utc) {
  std::tm parts{};
  int ms = 0;
  if (std::sscanf(utc.c_str(), "%d-%d-%dT%d:%d:%d.%dZ", &parts.tm_year, &parts.tm_mon,
                  &parts.tm_mday, &parts.tm_hour, &parts.tm_min, &parts.tm_sec, &ms) != 7) {
    throw std::runtime_error("not a time: " + utc);
  }
  parts.tm_year -= 1900;
  parts.tm_mon -= 1;
  return std::chrono::seconds(timegm(&parts)) + milliseconds(ms);
}

}  // namespace

std::optional<milliseconds> wheel_told_to_stop(const std::filesystem::path& witness,
                                               const std::string& since, const std::string& until,
                                               double time_scale) {
  for (const std::string& text : witness_lines(witness)) {
    const nlohmann::json line = nlohmann::json::parse(text);
    if (line.at("event") != "spindle_stopped" || line.at("time") < since) continue;
    const std::chrono::duration<double> run_down(line.at("run_down_s").get<double>() / time_scale);
    const milliseconds told = moment(line.at("time")) - std::chrono::round<milliseconds>(run_down);
    // That it ran down already is told by times that are rounded.
    if (told + milliseconds(1) < moment(since)) continue;
    if (told > moment(until)) return std::nullopt;
    return std::max(told - moment(since), milliseconds(0));
  }
  return std::nullopt;
}

}  // namespace biotomy::tests
