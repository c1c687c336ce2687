#pragma once

#include <optional>

#include "sim/service/rig.hpp"
#include "sim/service/rig_server.hpp"

namespace biotomy::sim {

/// What no real rig has: the hand that presses the e-stop, opens the door, breaks things and mends
/// them.
class BenchService final : public RigServiceHandler {
 public:
  explicit BenchService(Rig& rig) : rig_(rig) {}
  std::optional<bridge::WelcomeMessage> welcome() override { return bridge::WelcomeMessage{}; }
  std::optional<bridge::RigAnswer> answer(const bridge::RigMessage& request) override;

 private:
  Rig& rig_;
};

}  // namespace biotomy::sim
