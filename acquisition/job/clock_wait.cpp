#include "acquisition/job/clock_wait.hpp"

#include "acquisition/job/preflight_complaints.hpp"
#include "acquisition/records/utc_time.hpp"

namespace biotomy::acquisition {

ClockWait::ClockWait(const SafetyLimits& limits) : limits_(limits) {}

void ClockWait::begin() {
  record_at_.clear();
  waiting_for_.clear();
  began_.reset();
}

void ClockWait::is_behind(const std::string& record_at) {
  record_at_ = record_at;
}

bool ClockWait::poll(std::chrono::system_clock::time_point clock, TimePoint now) {
  const Complaints complaints = clock_complaints(clock, record_at_);
  if (complaints.empty()) {
    begin();
    return true;
  }
  if (!began_) began_ = now;
  if (now - *began_ >= limits_.preflight_limit) {
    // A clock that cannot be right is no witness against a record.
    if (clock_complaints(clock, "").empty()) wrong_record_ = record_at_;
    throw StepFailure(complaints.front());
  }
  waiting_for_ = "waits for the computer's clock to be set: it says " + utc_text(clock) +
                 (record_at_.empty() ? "" : ", and the journal's last record is of " + record_at_);
  return false;
}

}  // namespace biotomy::acquisition
