#pragma once

#include <cstdint>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <utility>

#include "firmware_bridge/device_error.hpp"
#include "firmware_bridge/stage/stage.hpp"

namespace biotomy::acquisition {

/// How often the controller was asked, and how often that failed. Safe for many threads.
class LinkCounts {
 public:
  void call(const char* name);
  void error(const char* name, bridge::DeviceError::Kind kind);
  void repeated_command();

  std::map<std::string, std::uint64_t> calls() const;
  /// By call and by kind of error.
  std::map<std::pair<std::string, std::string>, std::uint64_t> errors() const;
  std::uint64_t repeated_commands() const;

 private:
  mutable std::mutex mutex_;
  std::map<std::string, std::uint64_t> calls_;
  std::map<std::pair<std::string, std::string>, std::uint64_t> errors_;
  std::uint64_t repeated_commands_ = 0;
};

/// A stage that is counted. Stage and counts outlive it.
class CountedStage final : public bridge::Stage {
 public:
  CountedStage(bridge::Stage& stage, LinkCounts& counts) : stage_(stage), counts_(counts) {}

  bridge::StageIdentity identify() override;
  bridge::StageStatus look() override;
  bridge::StageStatus exchange(std::uint16_t heartbeat) override;
  void issue(std::uint32_t sequence, const bridge::StageCommand& command) override;

 private:
  template <typename Call>
  auto counted(const char* name, Call call);

  bridge::Stage& stage_;
  LinkCounts& counts_;
  std::optional<std::uint32_t> last_sequence_;
};

}  // namespace biotomy::acquisition
