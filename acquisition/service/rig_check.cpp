#include "acquisition/service/rig_check.hpp"

#include <thread>

#include "acquisition/records/sample_lock.hpp"
#include "acquisition/service/devices.hpp"
#include "acquisition/service/rig_check_devices.hpp"
#include "acquisition/service/rig_check_records.hpp"

namespace biotomy::acquisition {

RigCheckParts real_check_parts(const Configuration& configuration) {
  return {.make_stage = [&configuration] { return make_stage(configuration.stage); },
          .make_lines = [&configuration] { return make_lines(configuration.lines); },
          .make_camera = [&configuration] { return make_camera(configuration.camera); },
          .surroundings = real_surroundings(),
          .now = std::chrono::steady_clock::now,
          .wait = [](std::chrono::milliseconds time) { std::this_thread::sleep_for(time); }};
}

RigFindings check_rig(const Configuration& configuration, const RigCheckParts& parts) {
  RigFindings findings;
  AnsweredRig rig;
  if (SampleLock::is_held(configuration.job.plan.sample)) {
    findings.wrong("daemon",
                   "a biotomyd works on this sample and has the devices, so they were not asked: "
                   "biotomy rig status tells of them, or stop it first");
  } else {
    rig = check_devices(configuration, parts, findings);
    check_address(configuration.service, findings);
  }
  check_records(configuration.job, rig, parts.surroundings, findings);
  check_service(configuration, findings);
  return findings;
}

}  // namespace biotomy::acquisition
