#include "acquisition/service/notifications/command_channel.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <optional>
#include <thread>
#include <utility>

#include <fcntl.h>
#include <nlohmann/json.hpp>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <sysexits.h>
#include <unistd.h>

#include "firmware_bridge/wire/unique_fd.hpp"

namespace biotomy::acquisition {
namespace {

using bridge::UniqueFd;
using std::chrono::steady_clock;

constexpr std::chrono::milliseconds kLook{10};  // between two looks whether it has ended
constexpr std::size_t kLongestWords = 200;

/// What the program is started with.
class SpawnPlan {
 public:
  SpawnPlan(int input, int errors) {
    posix_spawn_file_actions_init(&actions_);
    posix_spawn_file_actions_adddup2(&actions_, input, STDIN_FILENO);
    posix_spawn_file_actions_addopen(&actions_, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
    posix_spawn_file_actions_adddup2(&actions_, errors, STDERR_FILENO);
    posix_spawnattr_init(&attributes_);
    sigset_t signals;
    sigemptyset(&signals);
    posix_spawnattr_setsigmask(&attributes_, &signals);
    sigaddset(&signals, SIGPIPE);
    posix_spawnattr_setsigdefault(&attributes_, &signals);
    posix_spawnattr_setpgroup(&attributes_, 0);
    posix_spawnattr_setflags(
        &attributes_, POSIX_SPAWN_SETPGROUP | POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF);
  }
  ~SpawnPlan() {
    posix_spawn_file_actions_destroy(&actions_);
    posix_spawnattr_destroy(&attributes_);
  }
  SpawnPlan(const SpawnPlan&) = delete;
  SpawnPlan& operator=(const SpawnPlan&) = delete;

  pid_t start(const std::vector<std::string>& command,
              const std::vector<std::string>& environment) {
    const auto pointers = [](const std::vector<std::string>& words) {
      std::vector<char*> list;
      list.reserve(words.size() + 1);
      for (const std::string& word : words) list.push_back(const_cast<char*>(word.c_str()));
      list.push_back(nullptr);
      return list;
    };
    const std::vector<char*> words = pointers(command);
    const std::vector<char*> variables = pointers(environment);
    pid_t process = -1;
    const int error =
        ::posix_spawnp(&process, words[0], &actions_, &attributes_, words.data(), variables.data());
    if (error != 0) {
      throw DeliveryError(command[0] + " cannot be started: " + std::strerror(error));
    }
    return process;
  }

 private:
  posix_spawn_file_actions_t actions_{};
  posix_spawnattr_t attributes_{};
};

/// A program at work in a process group of its own; one that has not ended when the object goes is
/// killed with its group.
class Process {
 public:
  explicit Process(pid_t pid) : pid_(pid) {}
  ~Process() {
    if (status_) return;
    ::kill(-pid_, SIGKILL);
    while (::waitpid(pid_, nullptr, 0) < 0 && errno == EINTR) {
    }
  }
  Process(const Process&) = delete;
  Process& operator=(const Process&) = delete;

  std::optional<int> status() {
    int status = 0;
    if (!status_ && ::waitpid(pid_, &status, WNOHANG) == pid_) status_ = status;
    return status_;
  }

 private:
  pid_t pid_;
  std::optional<int> status_;
};

UniqueFd file_in_memory(const std::string& content) {
  UniqueFd file(::memfd_create("notification", MFD_CLOEXEC));
  const auto length = static_cast<ssize_t>(content.size());
  if (!file.valid() || ::pwrite(file.get(), content.data(), content.size(), 0) != length) {
    throw DeliveryError(std::string("no memory for the message: ") + std::strerror(errno));
  }
  return file;
}

/// The daemon's environment and what it is to know of the message.
std::vector<std::string> environment_of(const std::string& message) {
  std::vector<std::string> variables;
  for (char** variable = environ; *variable != nullptr; ++variable) {
    const std::string text = *variable;
    // Not what ties the daemon to systemd, and no variable of ours that means something else.
    const bool private_to_us = text.starts_with("BIOTOMY_") || text.starts_with("NOTIFY_SOCKET=") ||
                               text.starts_with("WATCHDOG_");
    if (!private_to_us) variables.push_back(text);
  }
  const nlohmann::json document = nlohmann::json::parse(message);
  const auto add = [&](const char* name, std::string value) {
    std::erase(value, '\0');
    variables.push_back(std::string(name) + "=" + value);
  };
  add("BIOTOMY_KIND", document.at("kind"));
  add("BIOTOMY_OVER", document.at("over").get<bool>() ? "true" : "false");
  add("BIOTOMY_TEXT", document.at("text"));
  add("BIOTOMY_JOB", document.at("job"));
  return variables;
}

/// What it said first on standard error, in one line.
std::string words_of(const UniqueFd& errors) {
  std::array<char, kLongestWords> part{};
  const ssize_t count = ::pread(errors.get(), part.data(), part.size(), 0);
  std::string text(part.data(), count > 0 ? static_cast<std::size_t>(count) : 0);
  text.erase(std::min(text.find_first_of("\r\n"), text.size()));
  return text.empty() ? "" : ": " + text;
}

}  // namespace

CommandChannel::CommandChannel(std::vector<std::string> command) : command_(std::move(command)) {}

void CommandChannel::deliver(const std::string& message, std::chrono::milliseconds time_out,
                             const std::stop_token& stop) {
  const UniqueFd input = file_in_memory(message);
  const UniqueFd errors = file_in_memory("");
  const auto limit = steady_clock::now() + time_out;
  Process process(SpawnPlan(input.get(), errors.get()).start(command_, environment_of(message)));
  while (!process.status()) {
    if (stop.stop_requested()) throw DeliveryError(command_[0] + " was stopped with the daemon");
    if (steady_clock::now() > limit) {
      throw DeliveryError(command_[0] + " took longer than " + std::to_string(time_out.count()) +
                          " ms" + words_of(errors));
    }
    std::this_thread::sleep_for(kLook);
  }
  const int status = *process.status();
  if (WIFEXITED(status) && WEXITSTATUS(status) == 0) return;
  const std::string end = WIFEXITED(status) ? "exit code " + std::to_string(WEXITSTATUS(status))
                                            : "signal " + std::to_string(WTERMSIG(status));
  const std::string failure = command_[0] + " failed, " + end + words_of(errors);
  if (WIFEXITED(status) && WEXITSTATUS(status) == EX_DATAERR) throw MessageRefused(failure);
  throw DeliveryError(failure);
}

}  // namespace biotomy::acquisition
