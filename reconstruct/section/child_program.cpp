#include "reconstruct/section/child_program.hpp"

#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>

#include <fcntl.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include "reconstruct/errors.hpp"

namespace biotomy::reconstruct {
namespace {

[[noreturn]] void fail(const std::string& program, int error) {
  throw SampleError(
      error == ENOENT
          ? "the program '" + program + "' is not installed: install Debian's package " + program
          : "the program '" + program + "' can't be started: " + std::strerror(error));
}

/// What posix_spawn is told: the three standard descriptors, a process group, no inherited mask.
class SpawnPlan {
 public:
  SpawnPlan(int input, int output, int errors) {
    posix_spawn_file_actions_init(&actions_);
    posix_spawn_file_actions_adddup2(&actions_, input, STDIN_FILENO);
    posix_spawn_file_actions_adddup2(&actions_, output, STDOUT_FILENO);
    posix_spawn_file_actions_adddup2(&actions_, errors, STDERR_FILENO);
    posix_spawnattr_init(&attributes_);
    sigset_t none;
    sigemptyset(&none);
    posix_spawnattr_setsigmask(&attributes_, &none);
    posix_spawnattr_setpgroup(&attributes_, 0);
    posix_spawnattr_setflags(&attributes_, POSIX_SPAWN_SETPGROUP | POSIX_SPAWN_SETSIGMASK);
  }
  ~SpawnPlan() {
    posix_spawn_file_actions_destroy(&actions_);
    posix_spawnattr_destroy(&attributes_);
  }
  SpawnPlan(const SpawnPlan&) = delete;
  SpawnPlan& operator=(const SpawnPlan&) = delete;

  pid_t start(const std::vector<std::string>& command) {
    std::vector<char*> words;
    words.reserve(command.size() + 1);
    for (const std::string& word : command) {
      words.push_back(const_cast<char*>(word.c_str()));
    }
    words.push_back(nullptr);
    pid_t process = -1;
    const int error =
        ::posix_spawnp(&process, words[0], &actions_, &attributes_, words.data(), environ);
    if (error != 0) {
      fail(command[0], error);
    }
    return process;
  }

 private:
  posix_spawn_file_actions_t actions_{};
  posix_spawnattr_t attributes_{};
};

std::string content_of(const FileDescriptor& file) {
  std::string text;
  std::array<char, 4096> part{};
  for (;;) {
    const ssize_t count =
        ::pread(file.get(), part.data(), part.size(), static_cast<off_t>(text.size()));
    if (count <= 0) {
      return text;
    }
    text.append(part.data(), static_cast<std::size_t>(count));
  }
}

}  // namespace

ChildProgram::ChildProgram(const std::vector<std::string>& command)
    : output_(::memfd_create("output", MFD_CLOEXEC)),
      errors_(::memfd_create("errors", MFD_CLOEXEC)) {
  // A pair of sockets rather than a pipe: what is sent into it can be kept from raising SIGPIPE.
  std::array<int, 2> ends{-1, -1};
  if (!output_.is_open() || !errors_.is_open() ||
      ::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()) != 0) {
    fail(command.at(0), errno);
  }
  input_ = FileDescriptor(ends[0]);
  const FileDescriptor its_end(ends[1]);
  process_ = SpawnPlan(its_end.get(), output_.get(), errors_.get()).start(command);
}

ChildProgram::~ChildProgram() {
  if (!exit_code_) {
    ::kill(process_, SIGKILL);
    finish();
  }
}

bool ChildProgram::feed(std::span<const std::byte> bytes) {
  while (!bytes.empty()) {
    const ssize_t count = ::send(input_.get(), bytes.data(), bytes.size(), MSG_NOSIGNAL);
    if (count < 0 && errno != EINTR) {
      return false;
    }
    if (count > 0) {
      bytes = bytes.subspan(static_cast<std::size_t>(count));
    }
  }
  return true;
}

int ChildProgram::finish() {
  if (exit_code_) {
    return *exit_code_;
  }
  input_ = FileDescriptor();
  int status = 0;
  while (::waitpid(process_, &status, 0) < 0 && errno == EINTR) {
  }
  exit_code_ = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  return *exit_code_;
}

std::string ChildProgram::output() const {
  return content_of(output_);
}

std::string ChildProgram::last_words() const {
  std::string text = content_of(errors_);
  text.erase(text.find_last_not_of("\r\n ") + 1);
  const std::size_t line = text.find_last_of("\r\n");
  return line == std::string::npos ? text : text.substr(line + 1);
}

}  // namespace biotomy::reconstruct
