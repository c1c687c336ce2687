#pragma once

#include "sim/service/rig.hpp"
#include "sim/service/rig_server.hpp"

namespace biotomy::sim {

/// The digital lines: reads e-stop and door, switches lamp, trigger and tower light.
class LineService final : public RigServiceHandler {
 public:
  explicit LineService(Rig& rig) : rig_(rig) {}
  std::optional<bridge::WelcomeMessage> welcome() override;
  std::optional<bridge::RigAnswer> answer(const bridge::RigMessage& request) override;

 private:
  Rig& rig_;
};

}  // namespace biotomy::sim
