#include "acquisition/service/counted_stage.hpp"

namespace biotomy::acquisition {
namespace {

const char* name_of(bridge::DeviceError::Kind kind) {
  using enum bridge::DeviceError::Kind;
  switch (kind) {
    case timeout:
      return "timeout";
    case disconnected:
      return "disconnected";
    case refused:
      return "refused";
    case configuration:
      return "configuration";
  }
  return "other";
}

}  // namespace

void LinkCounts::call(const char* name) {
  const std::scoped_lock lock(mutex_);
  ++calls_[name];
}

void LinkCounts::error(const char* name, bridge::DeviceError::Kind kind) {
  const std::scoped_lock lock(mutex_);
  ++errors_[{name, name_of(kind)}];
}

void LinkCounts::repeated_command() {
  const std::scoped_lock lock(mutex_);
  ++repeated_commands_;
}

std::map<std::string, std::uint64_t> LinkCounts::calls() const {
  const std::scoped_lock lock(mutex_);
  return calls_;
}

std::map<std::pair<std::string, std::string>, std::uint64_t> LinkCounts::errors() const {
  const std::scoped_lock lock(mutex_);
  return errors_;
}

std::uint64_t LinkCounts::repeated_commands() const {
  const std::scoped_lock lock(mutex_);
  return repeated_commands_;
}

template <typename Call>
auto CountedStage::counted(const char* name, Call call) {
  counts_.call(name);
  try {
    return call();
  } catch (const bridge::DeviceError& error) {
    counts_.error(name, error.kind());
    throw;
  }
}

bridge::StageIdentity CountedStage::identify() {
  return counted("identify", [&] { return stage_.identify(); });
}

bridge::StageStatus CountedStage::look() {
  return counted("look", [&] { return stage_.look(); });
}

bridge::StageStatus CountedStage::exchange(std::uint16_t heartbeat) {
  return counted("exchange", [&] { return stage_.exchange(heartbeat); });
}

void CountedStage::issue(std::uint32_t sequence, const bridge::StageCommand& command) {
  if (last_sequence_ == sequence) counts_.repeated_command();
  last_sequence_ = sequence;
  counted("issue", [&] { stage_.issue(sequence, command); });
}

}  // namespace biotomy::acquisition
