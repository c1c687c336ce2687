#pragma once

#include "sim/service/rig.hpp"
#include "sim/service/rig_server.hpp"

namespace biotomy::sim {

/// The digital lines: reads e-stop and door, switches lamp, trigger and tower light.
class LineService final : public RigServiceHandler {
 public:
  explicit LineService(Rig& rig) : rig_(rig) {}
  bridge::WelcomeMessage welcome() const override { return {}; }
  bridge::RigAnswer answer(const bridge::RigMessage& request) override;

 private:
  Rig& rig_;
};

/// What no real rig has: the hand that presses the e-stop and opens the door.
class BenchService final : public RigServiceHandler {
 public:
  explicit BenchService(Rig& rig) : rig_(rig) {}
  bridge::WelcomeMessage welcome() const override { return {}; }
  bridge::RigAnswer answer(const bridge::RigMessage& request) override;

 private:
  Rig& rig_;
};

}  // namespace biotomy::sim
