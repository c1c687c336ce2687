#pragma once

#include <future>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace biotomy::acquisition {

enum class OperatorCommand {
  start,
  pause,
  resume,
  abort,
  acknowledge,
  calibrate_flat,
  calibrate_dark,
  calibrate_white,
  calibrate_focus,
  shut_down,  ///< from the system, not from a person: come to rest and start nothing more
};

const char* to_string(OperatorCommand command);

/// The commands that a person may give.
std::span<const OperatorCommand> personal_commands();

/// The command of that name, of those that a person may give; nothing for any other name.
std::optional<OperatorCommand> operator_command(std::string_view name);

/// Whether the job does it; if not, why the state forbids it.
struct OperatorReply {
  bool accepted = false;
  std::string sentence;
};

/// Where other threads lay down commands for the control thread.
class OperatorDesk {
 public:
  struct Request {
    OperatorCommand command = OperatorCommand::start;
    std::string reason;  ///< the operator's own words, for the journal
    std::string who;     ///< gave it, and from where; empty when it was the system
    std::promise<OperatorReply> reply;
  };

  std::future<OperatorReply> post(OperatorCommand command, std::string reason,
                                  std::string who = "");

  /// Something that operators did, or tried, and that is no command: for the journal.
  void remark(std::string text);

  /// For the control thread: all that lies there, in order. Each must be answered.
  std::vector<Request> take();
  std::vector<std::string> take_remarks();

 private:
  std::mutex mutex_;
  std::vector<Request> requests_;
  std::vector<std::string> remarks_;
};

}  // namespace biotomy::acquisition
