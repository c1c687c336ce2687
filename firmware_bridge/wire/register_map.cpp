#include "firmware_bridge/wire/register_map.hpp"

#include <algorithm>
#include <tuple>

#include "firmware_bridge/wire/checked_table.hpp"
#include "firmware_bridge/wire/nearest_name.hpp"

namespace biotomy::bridge {

namespace {

constexpr int kLastAddress = 65535;

RegisterType type_named(const std::string& name) {
  for (const RegisterType type : {RegisterType::u16, RegisterType::i16, RegisterType::u32,
                                  RegisterType::i32, RegisterType::f32}) {
    if (name == to_string(type)) return type;
  }
  throw ConfigurationError("register type \"" + name + "\" is not u16, i16, u32, i32 or f32");
}

WordOrder word_order_named(const std::string& name) {
  return name == "big" ? WordOrder::big : WordOrder::little;
}

RegisterEntry read_entry(const std::string& name, const CheckedTable& table,
                         WordOrder order_of_map) {
  RegisterEntry entry;
  entry.name = name;
  entry.table = table.get(TextKey{.name = "table", .choices = {"input", "holding"}}) == "input"
                    ? RegisterTable::input
                    : RegisterTable::holding;
  entry.address = static_cast<int>(
      table.get(IntegerKey{.name = "address", .minimum = 0, .maximum = kLastAddress}));
  entry.type = type_named(
      table.get(TextKey{.name = "type", .choices = {"u16", "i16", "u32", "i32", "f32"}}));
  entry.word_order = word_order_named(
      table.get(TextKey{.name = "word_order",
                        .fallback = order_of_map == WordOrder::big ? "big" : "little",
                        .choices = {"big", "little"}}));
  entry.scale =
      table.get(NumberKey{.name = "scale", .fallback = 1.0, .minimum = 1e-9, .maximum = 1e9});
  entry.unit = table.get(TextKey{.name = "unit", .fallback = "", .may_be_empty = true});
  const std::string access = table.get(TextKey{.name = "access", .choices = {"r", "w", "rw"}});
  entry.access = access == "r"   ? RegisterAccess::read
                 : access == "w" ? RegisterAccess::write
                                 : RegisterAccess::read_write;
  entry.description =
      table.get(TextKey{.name = "description", .fallback = "", .may_be_empty = true});

  if (entry.end() - 1 > kLastAddress) {
    table.reject("address", "a 32-bit value needs two registers, and there is none after 65535");
  }
  if (entry.table == RegisterTable::input && entry.access != RegisterAccess::read) {
    table.reject("access", "an input register can only be read; expected \"r\"");
  }
  return entry;
}

}  // namespace

int RegisterEntry::width() const {
  return type == RegisterType::u16 || type == RegisterType::i16 ? 1 : 2;
}

RegisterMap RegisterMap::read_file(const std::filesystem::path& file) {
  return from(CheckedTable::read_file(file));
}

RegisterMap RegisterMap::parse(std::string_view text, const std::string& source) {
  return from(CheckedTable::parse(text, source));
}

RegisterMap RegisterMap::from(const CheckedTable& document) {
  RegisterMap map;
  map.source_ = document.source();

  const CheckedTable head = document.table("map");
  map.name_ = head.get(TextKey{.name = "name"});
  map.version_ =
      static_cast<int>(head.get(IntegerKey{.name = "version", .minimum = 0, .maximum = 65535}));
  // 255 is what a Modbus TCP device without a unit of its own answers to.
  map.unit_id_ =
      static_cast<int>(head.get(IntegerKey{.name = "unit_id", .minimum = 1, .maximum = 255}));
  map.word_order_ =
      word_order_named(head.get(TextKey{.name = "word_order", .choices = {"big", "little"}}));

  const CheckedTable registers = document.table("registers");
  for (const auto& [name, table] : registers.named_tables()) {
    map.entries_.push_back(read_entry(name, table, map.word_order_));
  }
  document.refuse_unknown_keys();
  if (map.entries_.empty()) {
    throw ConfigurationError(map.source_ + ": registers: the map has none");
  }

  std::sort(map.entries_.begin(), map.entries_.end(), [](const auto& a, const auto& b) {
    return std::tie(a.table, a.address, a.name) < std::tie(b.table, b.address, b.name);
  });
  for (std::size_t i = 1; i < map.entries_.size(); ++i) {
    const RegisterEntry& before = map.entries_[i - 1];
    const RegisterEntry& entry = map.entries_[i];
    if (before.table == entry.table && before.end() > entry.address) {
      registers.table(entry.name)
          .reject("address", std::string(to_string(entry.table)) + " register " +
                                 std::to_string(entry.address) + " is already part of " +
                                 before.name);
    }
  }
  return map;
}

const RegisterEntry& RegisterMap::at(std::string_view name) const {
  const auto found = std::find_if(entries_.begin(), entries_.end(),
                                  [&](const RegisterEntry& entry) { return entry.name == name; });
  if (found != entries_.end()) return *found;

  std::vector<std::string> names;
  for (const RegisterEntry& entry : entries_) names.push_back(entry.name);
  const std::string nearest = nearest_name(name, names);
  throw ConfigurationError(source_ + ": registers." + std::string(name) +
                           ": missing; the map must say where it is" +
                           (nearest.empty() ? "" : " (it has \"" + nearest + "\")"));
}

int RegisterMap::extent(RegisterTable table) const {
  int extent = 0;
  for (const RegisterEntry& entry : entries_) {
    if (entry.table == table) extent = std::max(extent, entry.end());
  }
  return extent;
}

const char* to_string(RegisterTable table) {
  return table == RegisterTable::input ? "input" : "holding";
}

const char* to_string(RegisterType type) {
  switch (type) {
    case RegisterType::u16:
      return "u16";
    case RegisterType::i16:
      return "i16";
    case RegisterType::u32:
      return "u32";
    case RegisterType::i32:
      return "i32";
    case RegisterType::f32:
      return "f32";
  }
  return "?";
}

const char* to_string(RegisterAccess access) {
  switch (access) {
    case RegisterAccess::read:
      return "r";
    case RegisterAccess::write:
      return "w";
    case RegisterAccess::read_write:
      return "rw";
  }
  return "?";
}

}  // namespace biotomy::bridge
