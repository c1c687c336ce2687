#include "acquisition/job/hold.hpp"

#include <algorithm>

namespace biotomy::acquisition {
namespace {

/// Twice the reserve, so that the job does not come back for a single layer; and no less than what
/// the preflight asks for.
std::int64_t layers_needed(const SafetyLimits& limits, std::int64_t layers_left) {
  const std::int64_t some = std::int64_t{2} * limits.disk_reserve_layers;
  return limits.disk_for_whole_job ? std::max(some, layers_left) : some;
}

}  // namespace

Hold::Hold(const SafetyLimits& limits) : limits_(limits), conditioning_(limits) {}

void Hold::begin(For what, std::int64_t layers_left, TimePoint now) {
  what_ = what;
  layers_needed_ = layers_needed(limits_, layers_left);
  conditioning_.begin(now);
  answer_ = {};
  asked_at_ = now;
}

bool Hold::poll(const bridge::StageStatus& status, RecordKeeper& records, TimePoint now) {
  return what_ == For::temperature ? conditioning_.poll(status, now) : poll_disk(records, now);
}

bool Hold::poll_disk(RecordKeeper& records, TimePoint now) {
  if (answer_.valid()) {
    if (!is_ready(answer_)) return false;
    room_for_layers_ = answer_.get();
    return room_for_layers_ >= layers_needed_;
  }
  if (now - asked_at_ >= limits_.disk_look) {
    asked_at_ = now;
    answer_ = records.ask([](const SampleRecords& sample) { return sample.disk_left_layers(); });
  }
  return false;
}

std::string Hold::waiting_for() const {
  if (what_ == For::temperature) return conditioning_.waiting_for();
  return "waits for room on the disk: it has room for " + std::to_string(room_for_layers_) +
         " layers and needs " + std::to_string(layers_needed_);
}

}  // namespace biotomy::acquisition
