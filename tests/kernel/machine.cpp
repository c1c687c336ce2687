#include "tests/kernel/machine.hpp"

#include <cstdlib>
#include <stdexcept>

#include <signal.h>

namespace biotomy::tests {

namespace {

std::vector<std::string> boot_command(const std::filesystem::path& folder,
                                      const std::vector<std::string>& options,
                                      const std::vector<std::string>& command) {
  const char* kernel = std::getenv("BIOTOMY_KERNEL");
  if (kernel == nullptr) {
    throw std::runtime_error("BIOTOMY_KERNEL names no kernel; run scripts/test-kernel");
  }
  std::vector<std::string> boot{"/usr/bin/setsid", BIOTOMY_BOOT, kernel, folder};
  boot.insert(boot.end(), options.begin(), options.end());
  boot.emplace_back("--");
  boot.insert(boot.end(), command.begin(), command.end());
  return boot;
}

std::filesystem::path made(const std::filesystem::path& folder) {
  std::filesystem::create_directories(folder);
  return folder;
}

}  // namespace

Machine::Machine(const std::filesystem::path& folder, const std::vector<std::string>& options,
                 const std::vector<std::string>& command)
    : process_(boot_command(folder, options, command), made(folder)) {}

void Machine::cut_power() {
  if (process_.end()) return;
  // All of its processes in one call: one that outlived the kernel's would go on as a process of
  // this machine.
  kill(-process_.pid(), SIGKILL);
  process_.wait(std::chrono::seconds(10));
}

std::int64_t Machine::last_number_after(const std::string& text) {
  const std::string console = process_.end()->output;
  const std::size_t place = console.rfind(text);
  return place == std::string::npos ? 0 : std::atoll(console.c_str() + place + text.size());
}

}  // namespace biotomy::tests
