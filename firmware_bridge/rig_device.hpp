#pragma once

#include <chrono>
#include <string>

#include "firmware_bridge/device_error.hpp"
#include "firmware_bridge/wire/rig_client.hpp"

namespace biotomy::bridge {

/// Asks a rig's process on behalf of a device and takes only the kind of answer that belongs to the
/// question; whatever goes wrong becomes a DeviceError that begins with `device`.
RigAnswer ask_device(RigClient& client, const std::string& device, const RigMessage& request,
                     const char* expected_type, std::chrono::milliseconds time_out);

/// The DeviceError for the exception being handled, which must be one of RigClient's.
[[noreturn]] void rethrow_as_device_error(const RigClient& client, const std::string& device);

}  // namespace biotomy::bridge
