#include "tools/command_parameters.hpp"

#include <algorithm>
#include <array>
#include <string>
#include <string_view>

#include <CLI/CLI.hpp>

namespace biotomy::tools {
namespace {

constexpr std::array<std::string_view, 8> kLeftOut{"help", "SAMPLE",   "output", "movie",
                                                   "rate", "cache-mb", "stats",  "json"};

std::string name_of(const CLI::Option& option) {
  return option.get_lnames().empty() ? option.get_name() : option.get_lnames().front();
}

std::string value_of(const CLI::Option& option) {
  if (option.count() == 0) {
    return option.get_default_str();
  }
  std::string words;
  for (const std::string& word : option.results()) {
    words += (words.empty() ? "" : " ") + word;
  }
  return words;
}

}  // namespace

nlohmann::ordered_json command_parameters(const CLI::App& command) {
  nlohmann::ordered_json parameters = {{"command", command.get_name()}};
  for (const CLI::Option* option : command.get_options()) {
    const std::string name = name_of(*option);
    const std::string value = value_of(*option);
    if (!value.empty() && std::find(kLeftOut.begin(), kLeftOut.end(), name) == kLeftOut.end()) {
      parameters[name] = value;
    }
  }
  return parameters;
}

}  // namespace biotomy::tools
