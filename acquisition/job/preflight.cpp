#include "acquisition/job/preflight.hpp"

#include <sstream>

#include "acquisition/job/step_failure.hpp"

namespace biotomy::acquisition {
namespace {

bool inside(bridge::Micrometres position, const bridge::AxisLimits& limits) {
  return position >= limits.minimum && position <= limits.maximum;
}

std::string outside_text(const char* what, bridge::Micrometres position, const char* axis,
                         const bridge::AxisLimits& limits) {
  std::ostringstream text;
  text << what << " would be at " << position.value << " µm of the " << axis
       << ", outside its limits " << limits.minimum.value << " to " << limits.maximum.value
       << " µm: mend the configuration";
  return text.str();
}

}  // namespace

std::optional<std::string> stage_complaint(const JobSettings& settings,
                                           const bridge::StageIdentity& stage) {
  if (stage.watchdog_timeout.count() == 0 && settings.limits.require_watchdog) {
    return "the controller does not watch the daemon's heartbeat (watchdog_timeout is 0): set it, "
           "or set safety.require_watchdog to false";
  }
  for (const std::int64_t layer : {std::int64_t{1}, settings.plan.layers}) {
    const bridge::Micrometres face = settings.plan.face_of(layer);
    if (!inside(face, stage.feed)) {
      return outside_text(("layer " + std::to_string(layer)).c_str(), face, "feed", stage.feed);
    }
  }
  if (!inside(settings.focus.start, stage.column)) {
    return outside_text("focus.start_um", settings.focus.start, "column", stage.column);
  }
  return std::nullopt;
}

PreflightFindings inspect(const JobSettings& settings, bridge::Camera& camera,
                          const Surroundings& surroundings) {
  PreflightFindings findings;
  findings.camera = camera.describe();
  camera.apply(settings.camera.settings);
  findings.records =
      std::make_shared<SampleRecords>(settings.plan, settings.store, findings.camera, surroundings);
  findings.journal = findings.records->summary();
  findings.disk_left_layers = findings.records->disk_left_layers();

  const std::int64_t layers_to_do = settings.plan.layers - findings.journal.last_committed;
  const std::int64_t reserve = settings.limits.disk_reserve_layers;
  if (layers_to_do > 0 && findings.disk_left_layers < reserve) {
    throw StepFailure("the disk has room for " + std::to_string(findings.disk_left_layers) +
                      " more layers, less than disk_reserve_layers (" + std::to_string(reserve) +
                      "): make room");
  }
  return findings;
}

}  // namespace biotomy::acquisition
