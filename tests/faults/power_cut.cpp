#include "tests/faults/power_cut.hpp"

#include <algorithm>
#include <cstdio>
#include <ctime>
#include <stdexcept>
#include <utility>
#include <variant>

#include <nlohmann/json.hpp>

#include "acquisition/job/earlier_run.hpp"
#include "acquisition/job/recovery.hpp"
#include "acquisition/records/journal_reader.hpp"
#include "acquisition/records/sample_records.hpp"
#include "acquisition/records/surroundings.hpp"
#include "acquisition/service/configuration.hpp"
#include "reconstruct/disk/sha256.hpp"
#include "reconstruct/store/volume_verification.hpp"
#include "reconstruct/store/volume_writer.hpp"

namespace biotomy::tests {

namespace {

using namespace acquisition;
namespace fs = std::filesystem;

constexpr std::int64_t kMillisecond =
    1'000'000;  // in nanoseconds; as exact as the twin's times are

/// Of a time as the twin writes it: 2026-01-02T03:04:05.678Z.
std::int64_t nanoseconds_of(const std::string& utc) {
  std::tm parts{};
  int milliseconds = 0;
  if (std::sscanf(utc.c_str(), "%d-%d-%dT%d:%d:%d.%dZ", &parts.tm_year, &parts.tm_mon,
                  &parts.tm_mday, &parts.tm_hour, &parts.tm_min, &parts.tm_sec,
                  &milliseconds) != 7) {
    throw std::runtime_error("not a time: " + utc);
  }
  parts.tm_year -= 1900;
  parts.tm_mon -= 1;
  return (std::int64_t{1000} * timegm(&parts) + milliseconds) * kMillisecond;
}

}  // namespace

/// A sample as the power left it, opened as the daemon opens it.
class PowerCuts::Opened {
 public:
  Opened(const PowerCuts& run, const fs::path& sample) : run_(run), settings_(run.settings_) {
    settings_.plan.sample = sample;
    static_cast<void>(read_earlier_run(sample / "journal.sqlite"));
    bridge::CameraDescription camera;
    camera.width = run.width_;
    camera.height = run.height_;
    records_ = std::make_unique<SampleRecords>(settings_.plan, settings_.store, camera,
                                               real_surroundings());
    journal_ = records_->summary();
  }

  void check_layers(std::vector<std::string>& complaints) const {
    const JournalReader reader(settings_.plan.sample / "journal.sqlite");
    for (const LayerRow& layer : reader.committed_layers(1, settings_.plan.layers)) {
      const std::string hash = reconstruct::sha256_of_file(settings_.plan.sample / layer.file);
      const std::string& right = run_.hashes_.at(static_cast<std::size_t>(layer.layer - 1));
      if (hash != layer.sha256 || hash != right) {
        complaints.push_back("layer " + std::to_string(layer.layer) +
                             " is committed and is not what was photographed");
      }
    }
  }

  /// `sent`: layers whose grind had been sent for certain.
  void check_committed(std::int64_t sent, std::vector<std::string>& complaints) const {
    if (journal_.last_committed >= sent - 1) return;
    complaints.push_back("layer " + std::to_string(sent) + " was being ground, and only layer " +
                         std::to_string(journal_.last_committed) + " is committed");
  }

  /// The controller has finished so many passes.
  void check_recovery(std::int64_t passes, std::vector<std::string>& complaints) const {
    bridge::StageStatus controller;
    controller.state = bridge::ControllerState::idle;
    controller.grind_count = static_cast<std::uint32_t>(passes);
    controller.ground_to =
        passes == 0 ? bridge::Micrometres{} : settings_.plan.face_of(passes);  // as a new twin's
    const auto answer = where_to_go_on(settings_.plan, journal_, controller, settings_.limits);
    if (const auto* disagreement = std::get_if<Disagreement>(&answer)) {
      complaints.push_back(disagreement->sentence);
      return;
    }
    const auto& next = std::get<Continuation>(answer);
    const std::int64_t ground = next.ground ? next.layer : next.layer - 1;
    if (next.layer != journal_.last_committed + 1 || ground != passes) {
      complaints.push_back("it would go on with layer " + std::to_string(next.layer) +
                           (next.ground ? ", taken for ground" : ", to be ground") +
                           ", when the wheel has passed " + std::to_string(passes) + " times");
    }
  }

  /// After the volume has been gone on with, as the daemon does, to the last committed layer.
  void check_volume(std::vector<std::string>& complaints) const {
    fs::remove(records_->sample().layer_path(journal_.last_committed + 1));  // its name came first
    reconstruct::VolumeWriter(records_->sample(), settings_.store.volume_layout)
        .append(journal_.last_committed, true);
    reconstruct::verify_volume(
        records_->sample(), true,
        {.found =
             [&](const reconstruct::Finding& finding) {
               complaints.push_back(finding.file.string() + ": " + finding.what);
             },
         .progress = [](std::int64_t, std::int64_t) {}});
  }

 private:
  const PowerCuts& run_;
  JobSettings settings_;
  std::unique_ptr<SampleRecords> records_;
  JournalSummary journal_;
};

PowerCuts::PowerCuts(const SimulatedRig& rig, RecordedDisk disk)
    : scratch_(rig.folder() / "after-the-cut"),
      settings_(read_configuration(rig.folder() / "rig.toml").job),
      width_(rig.plan().width),
      height_(rig.plan().height),
      disk_(std::move(disk)) {
  const std::vector<nlohmann::json> commands = rig.witnessed("command_started");
  for (const nlohmann::json& pass : rig.witnessed("grind_pass")) {
    if (pass.at("result") != "done") continue;
    const auto command = std::find_if(commands.begin(), commands.end(), [&](const auto& each) {
      return each.at("sequence") == pass.at("sequence");
    });
    passes_.push_back({.begun_ns = nanoseconds_of(command->at("time")),
                       .finished_ns = nanoseconds_of(pass.at("time"))});
  }
  if (static_cast<std::int64_t>(passes_.size()) != rig.plan().layers) {
    throw std::runtime_error("the run that was recorded did not grind each layer once");
  }
  const JournalReader journal(rig.sample() / "journal.sqlite");
  for (const LayerRow& row : journal.committed_layers(1, rig.plan().layers)) {
    hashes_.push_back(row.sha256);
  }
}

PowerCuts PowerCuts::without_sync(std::size_t call) const {
  PowerCuts other = *this;
  other.disk_ = disk_.without_sync(call);
  return other;
}

std::vector<std::string> PowerCuts::complaints(std::size_t cut, PowerLoss loss,
                                               std::mt19937& random, Volume volume) const {
  fs::remove_all(scratch_);
  disk_.write_state(cut, loss, random, scratch_);

  // The power went at some moment after call `cut` − 1 and before the one that came next.
  const auto& calls = disk_.calls();
  const std::int64_t earliest = cut == 0 ? 0 : calls[cut - 1].time_ns;
  const std::int64_t latest = cut < calls.size() ? calls[cut].time_ns : INT64_MAX;
  const auto count = [&](auto was) { return std::count_if(passes_.begin(), passes_.end(), was); };
  // The twin tells whole milliseconds: what was begun counts from the next one on. A pass that
  // may have been finished counts as finished, as the controller finishes it by itself.
  const std::int64_t sent =
      count([&](const Pass& pass) { return pass.begun_ns + kMillisecond < earliest; });
  const std::int64_t least = count([&](const Pass& pass) { return pass.finished_ns < earliest; });
  const std::int64_t most = std::max<std::int64_t>(
      least, count([&](const Pass& pass) { return pass.begun_ns + kMillisecond < latest; }));

  std::vector<std::string> complaints;
  try {
    const Opened sample(*this, scratch_);
    sample.check_layers(complaints);
    sample.check_committed(sent, complaints);
    for (std::int64_t passes = least; passes <= most; ++passes) {
      sample.check_recovery(passes, complaints);
    }
    if (volume == Volume::kept) sample.check_volume(complaints);
  } catch (const std::exception& error) {
    complaints.emplace_back(error.what());
  }
  fs::remove_all(scratch_);
  return complaints;
}

std::size_t PowerCuts::call_before_grind(std::int64_t layer) const {
  const std::int64_t begun = passes_.at(static_cast<std::size_t>(layer - 1)).begun_ns;
  const auto& calls = disk_.calls();
  const auto next = std::find_if(calls.begin(), calls.end(), [&](const RecordedDisk::Call& call) {
    return call.time_ns > begun + kMillisecond;
  });
  return static_cast<std::size_t>(next - calls.begin()) - 1;
}

}  // namespace biotomy::tests
