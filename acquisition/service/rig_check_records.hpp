#pragma once

#include "acquisition/service/rig_check_devices.hpp"

namespace biotomy::acquisition {

/// Sample, journal, disk and clock, as far as the devices' answers allow. Makes nothing.
void check_records(const JobSettings& job, const AnsweredRig& rig, const Surroundings& surroundings,
                   RigFindings& findings);

/// That page and API can be where they are to be; of a daemon that does not run.
void check_address(const ServiceConfiguration& service, RigFindings& findings);

/// The token file, the folder of calibrations, and who is told when a person is needed.
void check_service(const Configuration& configuration, RigFindings& findings);

}  // namespace biotomy::acquisition
