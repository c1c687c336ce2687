#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace biotomy::bridge {

/// Why this process may not open a device file for reading and writing, and what to do; nothing
/// when it may. The device is not opened: opening alone makes some of them move a line.
std::optional<std::string> access_complaint(const std::filesystem::path& device);

/// The sentence for a device of that group that is closed to that user. Of a device that belongs to
/// root alone it names the udev rules.
std::string no_access_text(const std::filesystem::path& device, const std::string& group,
                           const std::string& user);

/// The other programs that have a device open, "ModemManager (process 412)". Those of other users
/// are seen by root alone. `processes` is where the kernel shows them.
std::vector<std::string> programs_with(const std::filesystem::path& device,
                                       const std::filesystem::path& processes = "/proc");

}  // namespace biotomy::bridge
