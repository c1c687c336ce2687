#pragma once

#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

namespace biotomy::acquisition {

/// A word as a POSIX shell takes it: in quotes where it holds anything but harmless letters.
std::string shell_word(const std::string& word);

/// An option of a command of `biotomy`, under its long name without dashes.
struct CommandOption {
  std::string name;
  std::string value;          ///< empty: not given
  std::string fallback = {};  ///< what the command takes when it is not given
};

/// `words`, and then those options that differ from what the command takes anyway.
std::string command_line(const std::vector<std::string>& words,
                         const std::vector<CommandOption>& options);

/// As the commands write down what they were asked for: {"command": …, and every option's value}.
nlohmann::ordered_json command_parameters(const std::string& command,
                                          const std::vector<CommandOption>& options);

}  // namespace biotomy::acquisition
