#pragma once

#include <chrono>
#include <optional>
#include <string>

#include "firmware_bridge/micrometres.hpp"
#include "firmware_bridge/wire/checked_table.hpp"

namespace biotomy::acquisition {

inline constexpr double kMetre = 1e6;  ///< in micrometres: no axis and no length is longer

// Keys of rig.toml by what they hold; each declares its key by reading it.

/// A whole number of milliseconds.
std::chrono::milliseconds duration(const bridge::CheckedTable& table, const char* name,
                                   std::chrono::milliseconds fallback, const char* description,
                                   int minimum = 1, int maximum = 86400000);

/// An axis position; required without a fallback.
bridge::Micrometres position(const bridge::CheckedTable& table, const char* name,
                             std::optional<bridge::Micrometres> fallback, const char* description);

/// A length above zero unless `minimum` says otherwise; required without a fallback.
bridge::Micrometres length(const bridge::CheckedTable& table, const char* name,
                           std::optional<bridge::Micrometres> fallback, const char* description,
                           double minimum = 0.001);

int count(const bridge::CheckedTable& table, const char* name, int fallback, int minimum,
          int maximum, const char* description);

double number(const bridge::CheckedTable& table, const char* name, double fallback,
              const char* unit, double minimum, double maximum, const char* description);

/// A text that may be empty.
std::string optional_text(const bridge::CheckedTable& table, const char* name,
                          const char* description, const std::string& fallback = "");

}  // namespace biotomy::acquisition
