#include "acquisition/job/operator_desk.hpp"

#include <array>
#include <utility>

namespace biotomy::acquisition {
namespace {

constexpr std::size_t kMostRemarks = 1000;  // lie there only when the control thread hangs

}  // namespace

const char* to_string(OperatorCommand command) {
  switch (command) {
    case OperatorCommand::start:
      return "start";
    case OperatorCommand::pause:
      return "pause";
    case OperatorCommand::resume:
      return "resume";
    case OperatorCommand::abort:
      return "abort";
    case OperatorCommand::acknowledge:
      return "acknowledge";
    case OperatorCommand::calibrate_flat:
      return "calibrate-flat";
    case OperatorCommand::calibrate_dark:
      return "calibrate-dark";
    case OperatorCommand::calibrate_white:
      return "calibrate-white";
    case OperatorCommand::calibrate_focus:
      return "calibrate-focus";
    case OperatorCommand::shut_down:
      return "shut_down";
  }
  return "?";
}

std::span<const OperatorCommand> personal_commands() {
  static constexpr std::array kPersonal = {
      OperatorCommand::start,          OperatorCommand::pause,
      OperatorCommand::resume,         OperatorCommand::abort,
      OperatorCommand::acknowledge,    OperatorCommand::calibrate_flat,
      OperatorCommand::calibrate_dark, OperatorCommand::calibrate_white,
      OperatorCommand::calibrate_focus};
  return kPersonal;
}

std::optional<OperatorCommand> operator_command(std::string_view name) {
  for (const OperatorCommand command : personal_commands()) {
    if (name == to_string(command)) return command;
  }
  return std::nullopt;
}

std::future<OperatorReply> OperatorDesk::post(OperatorCommand command, std::string reason,
                                              std::string who) {
  Request request{command, std::move(reason), std::move(who), {}};
  std::future<OperatorReply> reply = request.reply.get_future();
  const std::scoped_lock lock(mutex_);
  requests_.push_back(std::move(request));
  return reply;
}

void OperatorDesk::remark(std::string text) {
  const std::scoped_lock lock(mutex_);
  if (remarks_.size() < kMostRemarks) remarks_.push_back(std::move(text));
}

std::vector<OperatorDesk::Request> OperatorDesk::take() {
  const std::scoped_lock lock(mutex_);
  return std::exchange(requests_, {});
}

std::vector<std::string> OperatorDesk::take_remarks() {
  const std::scoped_lock lock(mutex_);
  return std::exchange(remarks_, {});
}

}  // namespace biotomy::acquisition
