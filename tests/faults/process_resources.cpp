#include "tests/faults/process_resources.hpp"

#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string>

namespace biotomy::tests {

ProcessResources resources_of(pid_t process) {
  const std::filesystem::path folder = "/proc/" + std::to_string(process);
  ProcessResources found;
  std::ifstream status(folder / "status");
  for (std::string word; status >> word;) {
    if (word == "VmRSS:") status >> found.resident_kib;
    if (word == "Threads:") status >> found.threads;
  }
  if (found.threads == 0) throw std::runtime_error(folder.string() + ": there is no such process");
  found.open_files = std::distance(std::filesystem::directory_iterator(folder / "fd"), {});
  return found;
}

}  // namespace biotomy::tests
