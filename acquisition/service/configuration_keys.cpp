#include "acquisition/service/configuration_keys.hpp"

namespace biotomy::acquisition {

using bridge::CheckedTable;
using bridge::IntegerKey;
using bridge::Micrometres;
using bridge::NumberKey;
using bridge::TextKey;
using std::chrono::milliseconds;

milliseconds duration(const CheckedTable& table, const char* name, milliseconds fallback,
                      const char* description, int minimum, int maximum) {
  return milliseconds(table.get(IntegerKey{.name = name,
                                           .fallback = fallback.count(),
                                           .unit = "ms",
                                           .minimum = minimum,
                                           .maximum = maximum,
                                           .description = description}));
}

Micrometres position(const CheckedTable& table, const char* name,
                     std::optional<Micrometres> fallback, const char* description) {
  return {table.get(NumberKey{.name = name,
                              .fallback = fallback ? std::optional(fallback->value) : std::nullopt,
                              .unit = "µm",
                              .minimum = -kMetre,
                              .maximum = kMetre,
                              .description = description})};
}

Micrometres length(const CheckedTable& table, const char* name, std::optional<Micrometres> fallback,
                   const char* description, double minimum) {
  return {table.get(NumberKey{.name = name,
                              .fallback = fallback ? std::optional(fallback->value) : std::nullopt,
                              .unit = "µm",
                              .minimum = minimum,
                              .maximum = kMetre,
                              .description = description})};
}

int count(const CheckedTable& table, const char* name, int fallback, int minimum, int maximum,
          const char* description) {
  return static_cast<int>(table.get(IntegerKey{.name = name,
                                               .fallback = fallback,
                                               .minimum = minimum,
                                               .maximum = maximum,
                                               .description = description}));
}

double number(const CheckedTable& table, const char* name, double fallback, const char* unit,
              double minimum, double maximum, const char* description) {
  return table.get(NumberKey{.name = name,
                             .fallback = fallback,
                             .unit = unit,
                             .minimum = minimum,
                             .maximum = maximum,
                             .description = description});
}

std::string optional_text(const CheckedTable& table, const char* name, const char* description,
                          const std::string& fallback) {
  return table.get(TextKey{.name = name,
                           .fallback = fallback,
                           .choices = {},
                           .may_be_empty = true,
                           .description = description});
}

}  // namespace biotomy::acquisition
