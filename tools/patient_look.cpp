#include "tools/patient_look.hpp"

#include <iostream>
#include <thread>

namespace biotomy::tools {

PatientLook::PatientLook(DaemonConnection& daemon, const Patience& patience)
    : daemon_(daemon), patience_(patience) {}

nlohmann::json PatientLook::status() {
  for (;;) {
    try {
      nlohmann::json status = daemon_.status();
      has_answered_ = true;
      away_since_.reset();
      return status;
    } catch (const DaemonAway& away) {
      if (!bears(away)) throw;
    }
    std::this_thread::sleep_for(patience_.pause);
  }
}

bool PatientLook::bears(const DaemonAway& away) {
  if (!has_answered_) return false;
  const TimePoint now = std::chrono::steady_clock::now();
  if (!away_since_ && patience_.most.count() > 0) {
    std::cerr << "biotomy: " << away.what() << " (it is asked again for "
              << std::chrono::ceil<std::chrono::seconds>(patience_.most).count() << " s)\n";
  }
  if (!away_since_) away_since_ = now;
  return now - *away_since_ < patience_.most;
}

}  // namespace biotomy::tools
