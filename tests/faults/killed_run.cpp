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

using std::chrono::seconds;
using std::chrono::steady_clock;

constexpr seconds kPatience(120);
constexpr seconds kLongestJob(280);
constexpr int kKilled = 128 + SIGKILL;

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

KilledRun::KilledRun(const RigPlan& plan)
    : rig_(plan),
      operator_([this](const std::string& command) { return rig_.rig(command); },
                [this] { return rig_.status(); }) {}

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
      operator_.go_on();
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
  // A photograph that the daemon asked for is taken after its death, and belongs to the kill.
  if (!rig_.daemon_runs()) rig_.await_idle_twin();
  const std::int64_t committed_then = committed();
  kills_.push_back({acquisition::utc_text(std::chrono::system_clock::now()), committed_then});
}

std::int64_t KilledRun::committed() const {
  return static_cast<std::int64_t>(
      read_run_journal(rig_.sample() / "journal.sqlite").layers.size());
}

void KilledRun::go_on() {
  if (!rig_.daemon_runs()) rig_.start_daemon();
  operator_.go_on();
}

void KilledRun::finish() {
  const auto deadline = steady_clock::now() + kLongestJob;
  for (;;) {
    go_on();
    const Outcome watched = rig_.rig(
        "watch", std::chrono::ceil<seconds>(deadline - steady_clock::now()), {"--patience", "0"});
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
