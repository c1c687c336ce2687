#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "tests/integration/child_process.hpp"

namespace biotomy::tests {

/// A computer that runs the test kernel (`boot`), switched off when the object goes.
class Machine {
 public:
  /// Boots, and runs `command`. `folder`: all that it may write to, beside its disk. `options`: for
  /// the kernel.
  Machine(const std::filesystem::path& folder, const std::vector<std::string>& options,
          const std::vector<std::string>& command);
  ~Machine() { cut_power(); }
  Machine(const Machine&) = delete;
  Machine& operator=(const Machine&) = delete;

  /// At once, whatever it is at. What it has not written to its disk is lost.
  void cut_power();

  /// Waits until the command says `text`, and returns the rest of the line. Throws
  /// std::runtime_error when it ends first or time is up.
  std::string wait_for(const std::string& text, std::chrono::seconds limit);

  /// The last number that the command said behind `text`; 0 if it said none.
  std::int64_t last_number_after(const std::string& text);

  /// Nothing while it runs.
  std::optional<Outcome> end() { return process_.end(); }

  /// The end of the command.
  Outcome wait(std::chrono::seconds limit) { return process_.wait(limit); }

 private:
  std::filesystem::path folder_;
  ChildProcess process_;
};

}  // namespace biotomy::tests
