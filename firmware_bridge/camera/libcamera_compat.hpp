// What differs between the versions of libcamera that Debian has had: 0.0.3 (12), 0.4 (13), 0.7
// (unstable). All else is written so that each of them takes it.
#pragma once

#include <libcamera/control_ids.h>
#include <libcamera/controls.h>
#include <libcamera/version.h>

namespace biotomy::bridge {

/// Whether a camera has a control. Not count(): where a pipeline shares the table of all controls'
/// names, that counts those.
inline bool has_control(const libcamera::ControlInfoMap& offered, unsigned int control) {
  return offered.find(control) != offered.end();
}

/// Takes exposure and gain out of the hands of the camera's automatic control. From 0.5 on each has
/// a mode of its own; AeEnable alone stays for the cameras that know no other.
inline void set_manual_exposure(const libcamera::ControlInfoMap& offered,
                                libcamera::ControlList& controls) {
  namespace id = libcamera::controls;
  if (has_control(offered, id::AE_ENABLE)) controls.set(id::AeEnable, false);
#if LIBCAMERA_VERSION_MAJOR > 0 || LIBCAMERA_VERSION_MINOR >= 5
  if (has_control(offered, id::EXPOSURE_TIME_MODE)) {
    controls.set(id::ExposureTimeMode, id::ExposureTimeModeManual);
  }
  if (has_control(offered, id::ANALOGUE_GAIN_MODE)) {
    controls.set(id::AnalogueGainMode, id::AnalogueGainModeManual);
  }
#endif
}

}  // namespace biotomy::bridge
