#include "acquisition/service/metrics/status_metrics.hpp"

#include <algorithm>

namespace biotomy::acquisition {
namespace {

using enum MetricType;

constexpr double kMicrometre = 1e-6;  // in metres
constexpr double kPercent = 0.01;
constexpr double kMillimetre = 1e-3;

MetricFamily one(const char* name, const char* help, double value) {
  return {name, gauge, help, {{{}, value}}};
}

template <typename Value>
MetricFamily maybe_one(const char* name, const char* help, const std::optional<Value>& value) {
  MetricFamily family{name, gauge, help};
  if (value) family.samples.push_back({{}, static_cast<double>(*value)});
  return family;
}

double flag(bool on) {
  return on ? 1.0 : 0.0;
}

MetricFamily state_family(const JobStatus& status) {
  MetricFamily family{"biotomy_job_state", gauge, "1 for the state that the job is in, else 0."};
  for (const JobState state : all_job_states()) {
    family.samples.push_back({{{"state", to_string(state)}}, flag(state == status.state)});
  }
  return family;
}

std::vector<MetricFamily> job_families(const JobStatus& status) {
  return {
      {"biotomy_build_info",
       gauge,
       "Always 1; the label tells the daemon's version.",
       {{{{"version", BIOTOMY_VERSION}}, 1.0}}},
      state_family(status),
      one("biotomy_alarm_active", "1 while an alarm waits for an operator.",
          flag(status.alarm.has_value())),
      one("biotomy_job_layers", "Layers of the whole job.", static_cast<double>(status.layers)),
      one("biotomy_job_layer", "The layer in work; 0 when none is.",
          static_cast<double>(status.layer)),
      one("biotomy_job_layers_committed", "Layers that are stored and recorded.",
          static_cast<double>(status.committed)),
      one("biotomy_job_attempt", "Attempts at the layer in work so far.",
          static_cast<double>(status.attempt)),
      maybe_one("biotomy_job_time_left_seconds", "Estimate of the time to the job's end.",
                status.seconds_left),
      maybe_one("biotomy_disk_left_layers", "How many more layers the disk has room for.",
                status.disk_left_layers),
      one("biotomy_volume_layers_behind", "Layers that are stored and not in the volume yet.",
          static_cast<double>(
              std::max<std::int64_t>(0, status.committed - status.volume.layers_present))),
      one("biotomy_volume_failed", "1 when the last growth of the volume failed.",
          flag(!status.volume.failure.empty())),
  };
}

std::vector<MetricFamily> layer_families(const JobStatus& status) {
  MetricFamily sharpness{"biotomy_last_layer_sharpness", gauge,
                         "Sharpness of the last layer, as its focus measure has it."};
  MetricFamily quality{"biotomy_last_layer_quality", gauge,
                       "A metric of the last layer's assessment, such as its sharpness_ratio."};
  MetricFamily limit{"biotomy_last_layer_quality_limit", gauge,
                     "The threshold that the metric was compared with."};
  if (status.last_layer) {
    const Assessment& assessment = status.last_layer->assessment;
    sharpness.samples.push_back({{}, assessment.sharpness});
    for (const Metric& metric : assessment.metrics) {
      quality.samples.push_back({{{"metric", metric.name}}, metric.value});
      limit.samples.push_back({{{"metric", metric.name}}, metric.limit});
    }
  }
  return {std::move(sharpness), std::move(quality), std::move(limit)};
}

std::vector<MetricFamily> stage_families(const JobStatus& status) {
  MetricFamily position{"biotomy_axis_position_meters", gauge,
                        "Where an axis is; that of the column is the focus."};
  MetricFamily temperature{"biotomy_temperature_celsius", gauge,
                           "Temperature of block or chamber."};
  MetricFamily load{"biotomy_spindle_load_ratio", gauge, "Load of the spindle; 1 is its rating."};
  MetricFamily speed{"biotomy_spindle_speed_hertz", gauge, "Turns of the spindle a second."};
  MetricFamily vibration{"biotomy_vibration_meters_per_second", gauge,
                         "Vibration as the controller measures it."};
  MetricFamily passes{"biotomy_grind_passes_total", counter,
                      "Grind passes that the controller has counted in its life."};
  if (status.stage) {
    const bridge::StageStatus& stage = *status.stage;
    position.samples = {{{{"axis", "feed"}}, stage.feed.value * kMicrometre},
                        {{{"axis", "traverse"}}, stage.traverse.value * kMicrometre},
                        {{{"axis", "column"}}, stage.column.value * kMicrometre}};
    temperature.samples = {{{{"place", "block"}}, stage.block_temperature_c},
                           {{{"place", "chamber"}}, stage.chamber_temperature_c}};
    load.samples = {{{}, stage.spindle_load_percent * kPercent}};
    speed.samples = {{{}, stage.spindle_rpm / 60.0}};
    vibration.samples = {{{}, stage.vibration_mm_s * kMillimetre}};
    passes.samples = {{{}, static_cast<double>(stage.grind_count)}};
  }
  return {one("biotomy_controller_answers", "1 when the controller answered in the last tick.",
              flag(status.controller_answers)),
          {"biotomy_interlock_open",
           gauge,
           "1 while a safety line says that the e-stop is pressed or the door is open.",
           {{{{"line", "estop"}}, flag(status.lines.estop_pressed)},
            {{{"line", "door"}}, flag(status.lines.door_open)}}},
          std::move(position),
          std::move(temperature),
          std::move(load),
          std::move(speed),
          std::move(vibration),
          std::move(passes)};
}

}  // namespace

std::vector<MetricFamily> status_metrics(const JobStatus& status) {
  std::vector<MetricFamily> families = job_families(status);
  for (MetricFamily& family : layer_families(status)) families.push_back(std::move(family));
  for (MetricFamily& family : stage_families(status)) families.push_back(std::move(family));
  return families;
}

}  // namespace biotomy::acquisition
