#include "acquisition/service/status_json.hpp"

#include <nlohmann/json.hpp>

#include "acquisition/focus/face_lean_json.hpp"
#include "acquisition/quality/metrics_json.hpp"
#include "acquisition/rig/alarm_kind.hpp"

namespace biotomy::acquisition {
namespace {

using nlohmann::json;

json stage_json(const JobStatus& status) {
  if (!status.stage) return nullptr;
  const bridge::StageStatus& stage = *status.stage;
  return {{"answers", status.controller_answers},
          {"controller_state", bridge::to_string(stage.state)},
          {"positions_um",
           {{"feed", stage.feed.value},
            {"traverse", stage.traverse.value},
            {"column", stage.column.value},
            {"ground_to", stage.ground_to.value}}},
          {"grind_count", stage.grind_count},
          {"spindle", {{"rpm", stage.spindle_rpm}, {"load_percent", stage.spindle_load_percent}}},
          {"vibration_mm_s", stage.vibration_mm_s},
          {"temperatures_c",
           {{"block", stage.block_temperature_c}, {"chamber", stage.chamber_temperature_c}}}};
}

json interlocks_json(const JobStatus& status) {
  json controller = nullptr;
  if (status.stage) {
    const bridge::Interlocks& interlocks = status.stage->interlocks;
    controller = {{"estop_pressed", interlocks.estop_pressed},
                  {"door_open", interlocks.door_open},
                  {"watchdog_tripped", interlocks.watchdog_tripped},
                  {"homed", interlocks.homed}};
  }
  return {{"lines",
           {{"estop_pressed", status.lines.estop_pressed}, {"door_open", status.lines.door_open}}},
          {"controller", controller}};
}

json last_layer_json(const std::optional<CommittedLayer>& layer) {
  if (!layer) return nullptr;
  return {{"layer", layer->layer},
          {"attempt", layer->attempt},
          {"verdict", to_string(layer->assessment.verdict)},
          {"reason", layer->assessment.reason},
          {"metrics", metrics_json(layer->assessment.metrics)}};
}

/// The job knows an attempt before the journal does, which gives it its id.
json last_attempt_json(const std::optional<JudgedAttempt>& judged,
                       const std::optional<AttemptNote>& noted) {
  if (!judged) return nullptr;
  const bool is_noted = noted && noted->layer == judged->layer && noted->attempt == judged->attempt;
  return {{"id", is_noted ? json(noted->id) : json(nullptr)},
          {"layer", judged->layer},
          {"attempt", judged->attempt},
          {"verdict", to_string(judged->verdict)},
          {"slug", judged->slug},
          {"reason", judged->reason}};
}

/// Each is [lowest, highest]; null where there is no such limit.
json limits_json(const SafetyLimits& limits) {
  return {{"block_temperature_c",
           {limits.block_temperature_minimum_c, limits.block_temperature_maximum_c}},
          {"chamber_temperature_c", nullptr},
          {"spindle_load_percent", {nullptr, limits.spindle_load_maximum_percent}},
          {"vibration_mm_s", {nullptr, limits.vibration_maximum_mm_s}}};
}

json commands_json(const std::vector<OperatorCommand>& commands) {
  json names = json::array();
  for (const OperatorCommand command : commands) names.push_back(to_string(command));
  return names;
}

json focus_json(const std::optional<FocusReport>& focus) {
  if (!focus) return nullptr;
  return {{"layer", focus->layer},          {"why", focus->why},
          {"found", focus->found},          {"why_not", focus->why_not},
          {"actuator", focus->actuator},    {"position", focus->position},
          {"plane_um", focus->plane.value}, {"frames", focus->frames},
          {"lean", lean_json(focus->lean)}};
}

template <typename Value>
json or_null(const std::optional<Value>& value) {
  return value ? json(*value) : json(nullptr);
}

/// Text of devices and files need not be UTF-8: what is not becomes a replacement character.
std::string dumped(const json& value) {
  return value.dump(-1, ' ', false, json::error_handler_t::replace);
}

json calibration_json(const CalibrationStatus& calibration) {
  using Progress = CalibrationStatus::Progress;
  if (calibration.kind.empty()) return nullptr;
  return {{"kind", calibration.kind},
          {"progress", calibration.progress == Progress::running ? "running"
                       : calibration.progress == Progress::done  ? "done"
                                                                 : "failed"},
          {"sentence", calibration.sentence}};
}

}  // namespace

std::string status_json(const JobStatus& status, const StatusContext& context) {
  json alarm = nullptr;
  if (status.alarm) {
    alarm = {{"cause", status.alarm->cause},
             {"since", status.alarm->since},
             {"state", to_string(status.alarm->state)},
             {"kind", to_string(status.alarm->kind)},
             {"advice", advice(status.alarm->kind)}};
  }
  json left_range = nullptr;
  if (status.seconds_left_range) {
    left_range = {status.seconds_left_range->low, status.seconds_left_range->high};
  }
  return dumped({{"version", BIOTOMY_VERSION},
                 {"state", to_string(status.state)},
                 {"waiting_for", status.waiting_for},
                 {"pause_requested", status.pause_requested},
                 {"pause_cause", status.pause_cause},
                 {"job", status.job},
                 {"sample", status.sample},
                 {"layer", status.layer},
                 {"layers", status.layers},
                 {"committed", status.committed},
                 {"attempt", status.attempt},
                 {"seconds_left", or_null(status.seconds_left)},
                 {"seconds_left_range", left_range},
                 {"stage", stage_json(status)},
                 {"interlocks", interlocks_json(status)},
                 {"limits", limits_json(context.limits)},
                 {"commands", commands_json(status.commands)},
                 {"last_attempt", last_attempt_json(status.last_attempt, context.last_attempt)},
                 {"last_layer", last_layer_json(status.last_layer)},
                 {"focus", focus_json(status.focus)},
                 {"disk_left_layers", or_null(status.disk_left_layers)},
                 {"alarm", alarm},
                 {"calibration", calibration_json(status.calibration)},
                 {"volume",
                  {{"layers_present", status.volume.layers_present},
                   {"finished", status.volume.finished},
                   {"failure", status.volume.failure}}}});
}

std::string reply_json(const std::string& message) {
  return dumped({{"accepted", true}, {"message", message}});
}

}  // namespace biotomy::acquisition
