#include "tests/faults/killed_run.hpp"

#include <csignal>
#include <stdexcept>
#include <thread>

#include <nlohmann/json.hpp>

#include "acquisition/records/utc_time.hpp"
#include "tests/faults/killing_point.hpp"
#include "tests/faults/run_journal.hpp"

namespace biotomy::tests {

namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using std::chrono::steady_clock;

constexpr seconds kPatience(120);
constexpr seconds kLongestJob(280);
constexpr milliseconds kPollInterval(20);
constexpr int kKilled = 128 + SIGKILL;

bool stands_still(const std::string& state) {
  return state == "faulted" || state == "paused" || state == "idle";
}

}  // namespace

UndisturbedRun::UndisturbedRun(const RigPlan& plan) : rig_(plan) {
  rig_.start_daemon();
  const Outcome started = rig_.rig("start");
  if (started.exit_code != 0) throw std::runtime_error(started.errors);
}

std::filesystem::path UndisturbedRun::sample() {
  const Outcome watched = rig_.rig("watch", kLongestJob);
  if (watched.exit_code != 0) throw std::runtime_error(watched.output + watched.errors);
  return rig_.sample();
}

void KilledRun::run_daemon_for(From from, std::chrono::microseconds time) {
  if (from == From::work) {
    go_on();
  } else {
    rig_.launch_daemon();
  }
  const std::jthread killer([&] {
    std::this_thread::sleep_for(time);
    rig_.send_daemon(SIGKILL);
  });
  await_kill(from == From::launch);
}

void KilledRun::run_daemon_to(const std::string& point) {
  rig_.launch_daemon(killed_at(point));
  await_kill(true);
}

void KilledRun::await_kill(bool go_on_meanwhile) {
  if (go_on_meanwhile) {
    try {
      rig_.await_daemon();
      operate();
    } catch (const std::runtime_error&) {
      // It was killed meanwhile; if it was not, the way it ends tells.
    }
  }
  const Outcome end = rig_.await_daemon_end(kPatience);
  if (end.exit_code != kKilled) {
    throw std::runtime_error("the daemon ended by itself: " + end.output + end.errors);
  }
  note_kill();
}

void KilledRun::note_kill() {
  const std::int64_t committed_then = committed();
  kills_.push_back({acquisition::utc_text(std::chrono::system_clock::now()), committed_then});
}

std::int64_t KilledRun::committed() const {
  return static_cast<std::int64_t>(
      read_run_journal(rig_.sample() / "journal.sqlite").layers.size());
}

void KilledRun::go_on() {
  if (!rig_.daemon_runs()) rig_.start_daemon();
  operate();
}

void KilledRun::operate() {
  const auto deadline = steady_clock::now() + kPatience;
  for (;;) {
    const nlohmann::json status = rig_.status();
    const std::string state = status.at("state");
    if (!stands_still(state) && state != "resetting") return;
    const nlohmann::json& alarm = status.at("alarm");
    const std::string cause = alarm.is_object() ? alarm.at("cause").get<std::string>() : "";
    if (steady_clock::now() > deadline) {
      throw std::runtime_error("the rig does not go on: " + status.dump(1));
    }
    act(state, cause);
  }
}

void KilledRun::act(const std::string& state, const std::string& alarm) {
  const bool just_started = alarm.find("the daemon has just started") != std::string::npos;
  Outcome
      outcome;  // of nothing, where the daemon has not looked at the rig yet: another look helps
  if (state == "paused") {
    outcome = rig_.rig("resume");
  } else if (state == "idle" || just_started) {
    outcome = rig_.rig("start");
    const bool latched = outcome.errors.find("acknowledge it first") != std::string::npos;
    if (latched) outcome = rig_.rig("acknowledge");
  } else if (state == "faulted" && !alarm.empty()) {
    outcome = rig_.rig("acknowledge");
    if (outcome.exit_code == 0) alarms_.push_back(alarm);
  }
  if (outcome.exit_code != 0) std::this_thread::sleep_for(kPollInterval);
}

void KilledRun::finish() {
  const auto deadline = steady_clock::now() + kLongestJob;
  for (;;) {
    go_on();
    const Outcome watched =
        rig_.rig("watch", std::chrono::ceil<seconds>(deadline - steady_clock::now()));
    if (watched.exit_code == 0) return;
    if (steady_clock::now() > deadline) throw std::runtime_error(watched.output + watched.errors);
  }
}

std::vector<std::string> KilledRun::verdict(const std::filesystem::path& undisturbed_sample) {
  const RigPlan& plan = rig_.plan();
  std::vector<std::string> complaints = judge({.witness = rig_.witness(),
                                               .sample = rig_.sample(),
                                               .layers = plan.layers,
                                               .first_face_um = plan.first_face_um,
                                               .layer_thickness_um = plan.layer_thickness_um,
                                               .kills = kills_},
                                              undisturbed_sample);
  const Outcome verified = run({BIOTOMY_TOOL, "verify", rig_.sample()}, rig_.folder(), kPatience);
  if (verified.exit_code != 0) complaints.push_back(verified.output + verified.errors);
  for (const auto& entry : std::filesystem::recursive_directory_iterator(rig_.sample())) {
    const bool is_hidden = entry.path().filename().string().front() == '.';
    if (is_hidden) complaints.push_back(entry.path().string() + " was left behind");
  }
  return complaints;
}

}  // namespace biotomy::tests
