#include "acquisition/viewer/command_line.hpp"

#include <string_view>

namespace biotomy::acquisition {
namespace {

constexpr std::string_view kHarmless =
    "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789_-+=:,./@%";

}  // namespace

std::string shell_word(const std::string& word) {
  if (!word.empty() && word.find_first_not_of(kHarmless) == std::string::npos) return word;
  std::string quoted = "'";
  for (const char letter : word) {
    if (letter == '\'') {
      quoted += R"('\'')";
    } else {
      quoted += letter;
    }
  }
  return quoted + '\'';
}

std::string command_line(const std::vector<std::string>& words,
                         const std::vector<CommandOption>& options) {
  std::string line;
  for (const std::string& word : words) {
    line += (line.empty() ? "" : " ") + shell_word(word);
  }
  for (const CommandOption& option : options) {
    if (option.value.empty() || option.value == option.fallback) continue;
    // With "=", as a value may begin with a dash.
    line += " --" + option.name + '=' + shell_word(option.value);
  }
  return line;
}

nlohmann::ordered_json command_parameters(const std::string& command,
                                          const std::vector<CommandOption>& options) {
  nlohmann::ordered_json parameters = {{"command", command}};
  for (const CommandOption& option : options) {
    const std::string& value = option.value.empty() ? option.fallback : option.value;
    if (!value.empty()) parameters[option.name] = value;
  }
  return parameters;
}

}  // namespace biotomy::acquisition
