#pragma once

#include <string>
#include <vector>

#include "firmware_bridge/wire/register_map.hpp"

namespace biotomy::bridge {

/// One request to read `count` registers from `address`.
struct RegisterBlock {
  RegisterTable table = RegisterTable::input;
  int address = 0;
  int count = 0;

  bool holds(const RegisterEntry& entry) const;
  friend bool operator==(const RegisterBlock&, const RegisterBlock&) = default;
};

/// The most registers one read may ask for (Modbus Application Protocol 1.1b3, 6.3 and 6.4).
inline constexpr int kMostRegistersInARead = 125;

/// The fewest reads that fetch the named values: neighbours go into one block, and a block runs
/// over registers that were not asked for if the map knows them as readable. Addresses that the map
/// does not know are never read, since a controller may refuse the whole request for one of them.
/// No value is split between two blocks. Throws ConfigurationError for a name the map lacks.
std::vector<RegisterBlock> plan_reads(const RegisterMap& map,
                                      const std::vector<std::string>& names);

}  // namespace biotomy::bridge
