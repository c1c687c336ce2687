#include "sim/service/witness_log.hpp"

#include <cerrno>
#include <cstdio>
#include <ctime>
#include <string>
#include <system_error>

#include <fcntl.h>
#include <nlohmann/json.hpp>
#include <unistd.h>

namespace biotomy::sim {

namespace {

using Json = nlohmann::ordered_json;

std::string utc(std::chrono::system_clock::time_point time) {
  const auto whole = std::chrono::floor<std::chrono::seconds>(time);
  const auto milliseconds =
      std::chrono::duration_cast<std::chrono::milliseconds>(time - whole).count();
  const std::time_t seconds = std::chrono::system_clock::to_time_t(whole);
  std::tm parts{};
  gmtime_r(&seconds, &parts);
  char date[32];
  std::strftime(date, sizeof(date), "%Y-%m-%dT%H:%M:%S", &parts);
  char text[48];
  std::snprintf(text, sizeof(text), "%s.%03dZ", date, static_cast<int>(milliseconds));
  return text;
}

Json facts_of(const Command& command) {
  return {{"sequence", command.sequence},
          {"action", name_of_action(command.action)},
          {"position_um", command.position_um},
          {"duration_ms", command.duration_ms},
          {"spindle_rpm", command.spindle_rpm}};
}

Json face_of(const Block& block) {
  return {{"mean_um", block.mean_um()},
          {"shallowest_um", block.shallowest_um()},
          {"deepest_um", block.deepest_um()}};
}

}  // namespace

WitnessLog::WitnessLog(const std::filesystem::path& file, Clock clock) : clock_(std::move(clock)) {
  if (file.empty()) {
    return;
  }
  file_ = bridge::UniqueFd(open(file.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0644));
  if (!file_.valid()) {
    throw std::system_error(errno, std::generic_category(), "witness_log " + file.string());
  }
}

void WitnessLog::write(double rig_s, const char* event, const Json& facts) {
  if (!file_.valid()) {
    return;
  }
  Json line{{"time", utc(clock_())}, {"rig_s", rig_s}, {"event", event}};
  line.update(facts);
  const std::string text = line.dump() + '\n';
  const std::lock_guard lock(writing_);
  if (::write(file_.get(), text.data(), text.size()) != static_cast<ssize_t>(text.size())) {
    throw std::system_error(errno, std::generic_category(), "writing the witness log");
  }
}

void WitnessLog::twin_started(double rig_s, std::uint64_t seed, const ControllerMemory& memory,
                              const Block& block) {
  write(rig_s, "twin_started",
        {{"seed", seed},
         {"version", BIOTOMY_VERSION},
         {"sequence", memory.sequence_finished},
         {"result", to_string(memory.result)},
         {"grind_count", memory.grind_count},
         {"passes", block.state().passes},
         {"face", face_of(block)}});
}

void WitnessLog::command_started(double rig_s, const Command& command) {
  write(rig_s, "command_started", facts_of(command));
}

void WitnessLog::command_finished(double rig_s, const Command& command, CommandResult result) {
  write(rig_s, "command_finished",
        {{"sequence", command.sequence},
         {"action", name_of_action(command.action)},
         {"result", to_string(result)}});
}

void WitnessLog::grind_pass(double rig_s, const Command& command, CommandResult result,
                            const Block& before, const Block& after, double wheel_worn_um) {
  write(rig_s, "grind_pass",
        {{"sequence", command.sequence},
         {"target_um", command.position_um},
         {"result", to_string(result)},
         {"passes", after.state().passes},
         {"before", face_of(before)},
         {"after", face_of(after)},
         {"removed_um", after.mean_um() - before.mean_um()},
         {"wheel_worn_um", wheel_worn_um}});
}

void WitnessLog::faulted(double rig_s, Fault fault) {
  write(rig_s, "faulted", {{"fault", to_string(fault)}});
}

void WitnessLog::fault_reset(double rig_s) {
  write(rig_s, "fault_reset", Json::object());
}

void WitnessLog::homed(double rig_s, bool homed) {
  write(rig_s, homed ? "homed" : "homing_lost", Json::object());
}

void WitnessLog::controller_power(double rig_s, bool on) {
  write(rig_s, on ? "controller_restarted" : "controller_power_lost", Json::object());
}

void WitnessLog::spindle_started(double rig_s, double target_rpm) {
  write(rig_s, "spindle_started", {{"target_rpm", target_rpm}});
}

void WitnessLog::spindle_stopped(double rig_s, double turned_s, double run_down_s) {
  write(rig_s, "spindle_stopped", {{"turned_s", turned_s}, {"run_down_s", run_down_s}});
}

void WitnessLog::fault_began(double rig_s, const ScenarioEvent& event) {
  write(rig_s, "fault_began", {{"name", event.name}, {"fault", name_of(event.fault)}});
}

void WitnessLog::fault_ended(double rig_s, const ScenarioEvent& event) {
  write(rig_s, "fault_ended", {{"name", event.name}, {"fault", name_of(event.fault)}});
}

void WitnessLog::input_changed(double rig_s, const char* input, bool on) {
  write(rig_s, "input_changed", {{"input", input}, {"on", on}});
}

void WitnessLog::output_changed(double rig_s, const char* output, bool on) {
  write(rig_s, "output_changed", {{"output", output}, {"on", on}});
}

void WitnessLog::capture(double rig_s, const CaptureFacts& facts) {
  write(rig_s, "capture",
        {{"number", facts.number},
         {"face_um", facts.face_um},
         {"column_um", facts.column_um},
         {"defocus_um", facts.defocus_um},
         {"blur_sigma_um", facts.blur_sigma_um},
         {"face_in_view", facts.face_in_view},
         {"lamp_on", facts.lamp_on},
         {"specks", facts.specks},
         {"lamp_share", facts.lamp_share},
         {"vibration_mm_s", facts.vibration_mm_s},
         {"spoilt", facts.spoilt}});
}

}  // namespace biotomy::sim
