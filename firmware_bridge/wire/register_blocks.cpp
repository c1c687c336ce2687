#include "firmware_bridge/wire/register_blocks.hpp"

#include <algorithm>

namespace biotomy::bridge {

bool RegisterBlock::holds(const RegisterEntry& entry) const {
  return entry.table == table && entry.address >= address && entry.end() <= address + count;
}

std::vector<RegisterBlock> plan_reads(const RegisterMap& map,
                                      const std::vector<std::string>& names) {
  std::vector<const RegisterEntry*> wanted;
  wanted.reserve(names.size());
  for (const std::string& name : names) wanted.push_back(&map.at(name));
  const auto is_wanted = [&](const RegisterEntry& entry) {
    return std::find(wanted.begin(), wanted.end(), &entry) != wanted.end();
  };

  // One pass over the map, which is sorted. `reach` is how far the present block could be drawn
  // through registers that the map knows; the block itself ends with the last one wanted.
  std::vector<RegisterBlock> blocks;
  int reach = 0;
  for (const RegisterEntry& entry : map.entries()) {
    const bool is_readable = entry.access != RegisterAccess::write;
    const bool is_neighbour =
        !blocks.empty() && blocks.back().table == entry.table && reach == entry.address;
    if (is_neighbour && is_readable) reach = entry.end();
    if (!is_wanted(entry)) continue;

    if (is_neighbour && is_readable &&
        entry.end() - blocks.back().address <= kMostRegistersInARead) {
      blocks.back().count = entry.end() - blocks.back().address;
    } else {
      blocks.push_back({entry.table, entry.address, entry.width()});
      reach = entry.end();
    }
  }
  return blocks;
}

}  // namespace biotomy::bridge
