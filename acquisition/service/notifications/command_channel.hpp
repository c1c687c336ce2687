#pragma once

#include <string>
#include <vector>

#include "acquisition/service/notifications/channel.hpp"

namespace biotomy::acquisition {

/// Starts a program for each message, without a shell. The message is JSON on its standard input;
/// its environment has in addition BIOTOMY_KIND, BIOTOMY_OVER ("true" or "false"), BIOTOMY_TEXT and
/// BIOTOMY_JOB. Exit code 0 is a delivery. A program that takes too long is killed together with
/// all that it started.
class CommandChannel final : public Channel {
 public:
  /// The program, looked for in PATH, and its arguments.
  explicit CommandChannel(std::vector<std::string> command);

  std::string name() const override { return "command"; }
  void deliver(const std::string& message, std::chrono::milliseconds time_out,
               const std::stop_token& stop) override;

 private:
  std::vector<std::string> command_;
};

}  // namespace biotomy::acquisition
