#pragma once

#include <cstdint>
#include <future>
#include <string>

#include "acquisition/records/record_keeper.hpp"
#include "acquisition/rig/conditioning.hpp"
#include "acquisition/rig/step_failure.hpp"
#include "acquisition/settings/safety_limits.hpp"
#include "firmware_bridge/stage/stage.hpp"

namespace biotomy::acquisition {

/// A job that waits until it can go on, for what the configuration lets it wait for: a block in its
/// window of temperature, or room on the disk.
class Hold {
 public:
  enum class For { temperature, disk };

  explicit Hold(const SafetyLimits& limits);

  /// `layers_left`: still to be made.
  void begin(For what, std::int64_t layers_left, TimePoint now);

  /// True when the job can go on. Throws StepFailure as Conditioning does.
  bool poll(const bridge::StageStatus& status, RecordKeeper& records, TimePoint now);

  std::string waiting_for() const;

 private:
  bool poll_disk(RecordKeeper& records, TimePoint now);

  SafetyLimits limits_;
  For what_ = For::temperature;
  Conditioning conditioning_;
  std::int64_t layers_needed_ = 0;
  std::int64_t room_for_layers_ = 0;  ///< when the disk was looked at last
  std::future<std::int64_t> answer_;
  TimePoint asked_at_{};
};

}  // namespace biotomy::acquisition
