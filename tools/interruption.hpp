#pragma once

#include <array>
#include <csignal>

namespace biotomy::tools {

/// While one is alive, the first SIGINT or SIGTERM only asks for an end between two pieces of work;
/// a second one ends the process as always. One at a time.
class Interruption {
 public:
  Interruption();
  ~Interruption();
  Interruption(const Interruption&) = delete;
  Interruption& operator=(const Interruption&) = delete;

  bool asked() const;

 private:
  std::array<struct sigaction, 2> before_{};
};

}  // namespace biotomy::tools
