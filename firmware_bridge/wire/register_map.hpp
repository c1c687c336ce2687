#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "firmware_bridge/wire/configuration_error.hpp"

namespace biotomy::bridge {

class CheckedTable;

enum class RegisterTable { input, holding };
enum class RegisterType { u16, i16, u32, i32, f32 };
enum class RegisterAccess { read, write, read_write };

/// Which register of a 32-bit value comes first: `big` the one with the higher 16 bits.
enum class WordOrder { big, little };

/// A named value of the controller and where it lies.
struct RegisterEntry {
  std::string name;
  RegisterTable table = RegisterTable::input;
  int address = 0;  ///< as it is in the request, from 0
  RegisterType type = RegisterType::u16;
  WordOrder word_order = WordOrder::big;  ///< of 32 bits; the map's, unless the entry has its own
  double scale = 1.0;                     ///< value in `unit` = raw number × scale; more than 0
  std::string unit;
  RegisterAccess access = RegisterAccess::read;
  std::string description;

  int width() const;  ///< in registers: 1 or 2
  int end() const { return address + width(); }
};

/// The registers of one kind of controller, by name: the single place where their addresses are.
/// A new PLC is a new file, not new code. Loading throws ConfigurationError for a map that cannot
/// be right: an unknown type, an address over 65535, two entries on one register, an input register
/// to be written.
class RegisterMap {
 public:
  static RegisterMap read_file(const std::filesystem::path& file);
  static RegisterMap parse(std::string_view text, const std::string& source);

  const std::string& name() const { return name_; }
  int version() const { return version_; }
  int unit_id() const { return unit_id_; }
  WordOrder word_order() const { return word_order_; }

  /// Throws ConfigurationError with the file and the name that it lacks.
  const RegisterEntry& at(std::string_view name) const;

  /// Input registers first, each table by rising address.
  const std::vector<RegisterEntry>& entries() const { return entries_; }

  /// One more than the last address used in `table`: how many registers a server has to hold.
  int extent(RegisterTable table) const;

  /// The file it came from, for messages.
  const std::string& source() const { return source_; }

 private:
  RegisterMap() = default;
  static RegisterMap from(const CheckedTable& document);

  std::string source_;
  std::string name_;
  int version_ = 0;
  int unit_id_ = 1;
  WordOrder word_order_ = WordOrder::big;
  std::vector<RegisterEntry> entries_;
};

const char* to_string(RegisterTable table);
const char* to_string(RegisterType type);
const char* to_string(RegisterAccess access);

}  // namespace biotomy::bridge
