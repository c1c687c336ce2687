#pragma once

#include <chrono>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <sys/types.h>

namespace biotomy::tests {

/// How a program ended, and what it said.
struct Outcome {
  int exit_code = -1;  ///< 128 + signal number when a signal ended it
  std::string output;
  std::string errors;
};

/// A program of ours in a process of its own; killed when the object goes out of scope. Its
/// standard output and error go to two files in `folder`.
class ChildProcess {
 public:
  ChildProcess(const std::vector<std::string>& command, const std::filesystem::path& folder);
  ~ChildProcess();
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;

  /// Waits until `text` stands in the output or the errors, and returns the rest of its line.
  /// Throws std::runtime_error with all that was said when the process ends first or time is up.
  std::string wait_for(const std::string& text, std::chrono::seconds limit);

  void send(int signal) const;

  pid_t pid() const { return pid_; }

  /// How it ended; nothing while it runs.
  std::optional<Outcome> end();

  /// Waits for the end. Throws std::runtime_error when time is up.
  Outcome wait(std::chrono::seconds limit);

 private:
  bool ended();
  std::string said() const;

  std::string name_;
  std::filesystem::path output_path_;
  std::filesystem::path error_path_;
  pid_t pid_ = -1;
  std::optional<int> exit_code_;
};

/// Runs a command to its end.
Outcome run(const std::vector<std::string>& command, const std::filesystem::path& folder,
            std::chrono::seconds limit = std::chrono::seconds(60));

}  // namespace biotomy::tests
