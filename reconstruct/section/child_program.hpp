#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <sys/types.h>

#include "reconstruct/disk/file_descriptor.hpp"

namespace biotomy::reconstruct {

/// Another program at work for ours: it is fed through its standard input, and what it says on
/// standard output and error is kept in memory. It has a process group of its own, so that Ctrl-C
/// on the terminal reaches us alone; when we die its input ends. Going out of scope kills it.
class ChildProgram {
 public:
  /// `command` is the program, looked for in PATH, and its arguments. Throws SampleError when it
  /// can't be started.
  explicit ChildProgram(const std::vector<std::string>& command);
  ~ChildProgram();
  ChildProgram(const ChildProgram&) = delete;
  ChildProgram& operator=(const ChildProgram&) = delete;

  /// False when it does not take all of `bytes`, because it has ended or closed its input. Never
  /// raises SIGPIPE.
  bool feed(std::span<const std::byte> bytes);

  /// Ends its input and waits for its end. Returns its exit code, 128 + the signal's number where
  /// one ended it.
  int finish();

  std::string output() const;

  /// What it said last on standard error, without line breaks; empty if nothing.
  std::string last_words() const;

 private:
  FileDescriptor input_;
  FileDescriptor output_;
  FileDescriptor errors_;
  pid_t process_ = -1;
  std::optional<int> exit_code_;
};

}  // namespace biotomy::reconstruct
