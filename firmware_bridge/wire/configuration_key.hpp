#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace biotomy::bridge {

// A key of a TOML file, declared where it is read: name, what it means, in which unit, which values
// it takes and what it is when the file doesn't say. Without a fallback the key is required.
// Declared with designated initialisers:
//   table.get(NumberKey{.name = "exposure", .fallback = 10.0, .unit = "ms", .minimum = 0.01,
//                       .description = "how long the shutter is open"});

struct TextKey {
  std::string name;
  std::optional<std::string> fallback{};
  std::vector<std::string> choices{};  ///< none: any text
  bool may_be_empty = false;
  std::string description{};
};

struct FlagKey {
  std::string name;
  std::optional<bool> fallback{};
  std::string description{};
};

struct IntegerKey {
  std::string name;
  std::optional<std::int64_t> fallback{};
  std::string unit{};
  std::int64_t minimum = std::numeric_limits<std::int64_t>::min();  ///< inclusive
  std::int64_t maximum = std::numeric_limits<std::int64_t>::max();  ///< inclusive
  std::string description{};
};

/// A finite number; an integer in the file will do.
struct NumberKey {
  std::string name;
  std::optional<double> fallback{};
  std::string unit{};
  double minimum = -std::numeric_limits<double>::max();  ///< inclusive
  double maximum = std::numeric_limits<double>::max();   ///< inclusive
  std::string description{};
};

/// An array of finite numbers, such as a point or a size.
struct NumbersKey {
  std::string name;
  std::optional<std::vector<double>> fallback{};
  std::string unit{};
  double minimum = -std::numeric_limits<double>::max();  ///< of each number, inclusive
  double maximum = std::numeric_limits<double>::max();   ///< of each number, inclusive
  std::size_t count = 0;  ///< how many there must be; 0 is any number
  std::string description{};
};

/// An array of texts, such as a program and its arguments.
struct TextsKey {
  std::string name;
  std::optional<std::vector<std::string>> fallback{};
  std::string description{};
};

/// A key as a reference page shows it.
struct DeclaredKey {
  std::string table;  ///< "job", "lines.lamp"; empty at the top
  std::string name;
  std::string type;           ///< "text", "texts", "flag", "integer", "number", "numbers"
  std::string default_value;  ///< as TOML; empty: required
  std::string unit;
  std::string allowed;  ///< "1 to 100", "\"pause\" or \"accept\""; empty: anything
  std::string description;
};

}  // namespace biotomy::bridge
