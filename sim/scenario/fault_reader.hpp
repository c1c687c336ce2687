#pragma once

#include <string>

#include "firmware_bridge/wire/checked_table.hpp"
#include "sim/scenario/rig_fault.hpp"

namespace biotomy::sim {

/// Reads the key `fault` and the parameters of the fault that it names.
/// Throws bridge::ConfigurationError.
RigFault read_fault(const bridge::CheckedTable& event);

/// The table of all faults and their parameters for README.md, in Markdown.
std::string fault_reference();

}  // namespace biotomy::sim
