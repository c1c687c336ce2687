#include "tests/integration/child_process.hpp"

#include <atomic>
#include <cerrno>
#include <cstring>
#include <stdexcept>
#include <thread>

#include <fcntl.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include "tests/file_content.hpp"

namespace biotomy::tests {

namespace {

constexpr std::chrono::milliseconds kPollInterval(10);

int exit_code_of(int status) {
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

}  // namespace

ChildProcess::ChildProcess(const std::vector<std::string>& command,
                           const std::filesystem::path& folder)
    : name_(std::filesystem::path(command.at(0)).filename()) {
  static std::atomic<int> count{0};
  const std::string stem = name_ + "-" + std::to_string(count++);
  output_path_ = folder / (stem + ".out");
  error_path_ = folder / (stem + ".err");

  std::vector<char*> arguments;
  for (const std::string& word : command) arguments.push_back(const_cast<char*>(word.c_str()));
  arguments.push_back(nullptr);
  const int input = open("/dev/null", O_RDONLY | O_CLOEXEC);
  const int output = open(output_path_.c_str(), O_CREAT | O_WRONLY | O_APPEND | O_CLOEXEC, 0600);
  const int error = open(error_path_.c_str(), O_CREAT | O_WRONLY | O_APPEND | O_CLOEXEC, 0600);
  pid_ = fork();
  if (pid_ < 0) throw std::runtime_error("fork: " + std::string(std::strerror(errno)));
  if (pid_ == 0) {
    prctl(PR_SET_PDEATHSIG, SIGKILL);  // a killed test leaves no rig running
    dup2(input, STDIN_FILENO);
    dup2(output, STDOUT_FILENO);
    dup2(error, STDERR_FILENO);
    execv(arguments[0], arguments.data());
    _exit(127);
  }
  for (const int descriptor : {input, output, error}) close(descriptor);
}

ChildProcess::~ChildProcess() {
  if (!ended()) {
    kill(pid_, SIGKILL);
    waitpid(pid_, nullptr, 0);
  }
}

std::string ChildProcess::wait_for(const std::string& text, std::chrono::seconds limit) {
  const auto deadline = std::chrono::steady_clock::now() + limit;
  for (;;) {
    const bool over = ended();  // asked before reading, so that the last words are not missed
    for (const std::filesystem::path& path : {output_path_, error_path_}) {
      const std::string content = content_of(path);
      const std::size_t found = content.find(text);
      if (found == std::string::npos) continue;
      const std::size_t end = content.find('\n', found);
      if (end != std::string::npos) {
        return content.substr(found + text.size(), end - found - text.size());
      }
    }
    if (over) throw std::runtime_error(name_ + " ended without saying '" + text + "'" + said());
    if (std::chrono::steady_clock::now() > deadline) {
      throw std::runtime_error(name_ + " did not say '" + text + "' in time" + said());
    }
    std::this_thread::sleep_for(kPollInterval);
  }
}

void ChildProcess::send(int signal) const {
  kill(pid_, signal);
}

std::optional<Outcome> ChildProcess::end() {
  if (!ended()) return std::nullopt;
  return Outcome{*exit_code_, content_of(output_path_), content_of(error_path_)};
}

Outcome ChildProcess::wait(std::chrono::seconds limit) {
  const auto deadline = std::chrono::steady_clock::now() + limit;
  while (!ended()) {
    if (std::chrono::steady_clock::now() > deadline) {
      throw std::runtime_error(name_ + " did not end in time" + said());
    }
    std::this_thread::sleep_for(kPollInterval);
  }
  return *end();
}

bool ChildProcess::ended() {
  int status = 0;
  if (!exit_code_ && waitpid(pid_, &status, WNOHANG) == pid_) exit_code_ = exit_code_of(status);
  return exit_code_.has_value();
}

std::string ChildProcess::said() const {
  return "\n--- output\n" + content_of(output_path_) + "--- errors\n" + content_of(error_path_);
}

Outcome run(const std::vector<std::string>& command, const std::filesystem::path& folder,
            std::chrono::seconds limit) {
  return ChildProcess(command, folder).wait(limit);
}

}  // namespace biotomy::tests
