#include "tests/kernel/machine.hpp"

#include <cstdlib>
#include <fstream>
#include <stdexcept>
#include <thread>

#include <signal.h>

#include "tests/file_content.hpp"

namespace biotomy::tests {

namespace {

constexpr const char* kOutput = "output";

std::vector<std::string> boot_command(const std::filesystem::path& folder,
                                      const std::vector<std::string>& options,
                                      const std::vector<std::string>& command) {
  const char* kernel = std::getenv("BIOTOMY_KERNEL");
  if (kernel == nullptr) {
    throw std::runtime_error("BIOTOMY_KERNEL names no kernel; run scripts/test-kernel");
  }
  std::vector<std::string> boot{BIOTOMY_BOOT, kernel, folder};
  boot.insert(boot.end(), options.begin(), options.end());
  boot.emplace_back("--");
  boot.insert(boot.end(), command.begin(), command.end());
  return boot;
}

/// Without what the last boot said.
std::filesystem::path prepared(const std::filesystem::path& folder) {
  std::filesystem::create_directories(folder);
  std::filesystem::remove(folder / kOutput);
  return folder;
}

}  // namespace

Machine::Machine(const std::filesystem::path& folder, const std::vector<std::string>& options,
                 const std::vector<std::string>& command)
    : folder_(folder), process_(boot_command(folder, options, command), prepared(folder)) {}

void Machine::cut_power() {
  if (process_.end()) return;
  // The kernel leads a process group. All of it in one call: a process that outlived the kernel's
  // would go on as one of this machine.
  std::ifstream file(folder_ / "machine/guest/pid");
  pid_t kernel = 0;
  if (file >> kernel && kernel > 1) kill(-kernel, SIGKILL);
  process_.wait(std::chrono::seconds(10));
}

std::string Machine::wait_for(const std::string& text, std::chrono::seconds limit) {
  const auto deadline = std::chrono::steady_clock::now() + limit;
  for (;;) {
    const bool is_over = process_.end().has_value();  // asked before reading
    const std::string said = content_of(folder_ / kOutput);
    const std::size_t begin = said.find(text);
    const std::size_t end = said.find('\n', begin);
    if (begin != std::string::npos && end != std::string::npos) {
      return said.substr(begin + text.size(), end - begin - text.size());
    }
    if (is_over || std::chrono::steady_clock::now() > deadline) {
      throw std::runtime_error("the machine did not say '" + text + "', but\n" + said);
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
}

std::int64_t Machine::last_number_after(const std::string& text) {
  const std::string said = content_of(folder_ / kOutput);
  const std::size_t place = said.rfind(text);
  return place == std::string::npos ? 0 : std::atoll(said.c_str() + place + text.size());
}

}  // namespace biotomy::tests
