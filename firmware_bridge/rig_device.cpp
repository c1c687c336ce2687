#include "firmware_bridge/rig_device.hpp"

#include <system_error>

namespace biotomy::bridge {

using Kind = DeviceError::Kind;

RigAnswer ask_device(RigClient& client, const std::string& device, const RigMessage& request,
                     const char* expected_type, std::chrono::milliseconds time_out) {
  try {
    RigAnswer answer = client.ask(request, time_out);
    if (type_of(answer.message) != expected_type) {
      client.disconnect();  // the answers no longer belong to the questions
      throw MessageError(type_of(request) + " was answered by " + type_of(answer.message));
    }
    return answer;
  } catch (...) {
    rethrow_as_device_error(client, device);
  }
}

void rethrow_as_device_error(const RigClient& client, const std::string& device) {
  const std::string who = device + " at unix://" + client.path().string() + ": ";
  try {
    throw;
  } catch (const RigSocketError& error) {
    throw DeviceError(
        error.kind() == RigSocketError::Kind::timeout ? Kind::timeout : Kind::disconnected,
        who + error.what());
  } catch (const RigRefusal& error) {
    throw DeviceError(Kind::refused, who + error.what());
  } catch (const MessageError& error) {
    throw DeviceError(Kind::configuration, who + error.what());
  } catch (const std::system_error& error) {
    throw DeviceError(Kind::refused, who + error.what());
  }
}

}  // namespace biotomy::bridge
