#pragma once

#include <cstdint>
#include <future>
#include <optional>

#include "acquisition/records/record_keeper.hpp"
#include "acquisition/rig/stage_commands.hpp"
#include "acquisition/settings/job_settings.hpp"

namespace biotomy::acquisition {

/// One grind pass, by the rules: the intent is committed to the journal before the command is
/// issued; afterwards the pass counter, the ground position and the feed must all say that exactly
/// this pass was done.
class GrindStep {
 public:
  GrindStep(const JobSettings& settings, StageCommands& commands, RecordKeeper& keeper);

  void begin(std::int64_t layer, const bridge::StageStatus& status);

  /// True when the layer's face is ground. Throws StepFailure.
  bool poll(const bridge::StageStatus& status, TimePoint now);

  const char* waiting_for() const;

 private:
  void check_done(const bridge::StageStatus& status) const;

  const JobSettings& settings_;
  StageCommands& commands_;
  RecordKeeper& keeper_;
  GrindRow grind_;
  std::future<void> intent_;
  bool issued_ = false;
};

}  // namespace biotomy::acquisition
