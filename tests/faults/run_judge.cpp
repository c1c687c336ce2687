#include "tests/faults/run_judge.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <sstream>

#include <opencv2/core/mat.hpp>

#include "reconstruct/disk/sha256.hpp"
#include "reconstruct/sample/layer_image.hpp"
#include "reconstruct/sample/sample_folder.hpp"
#include "tests/faults/run_journal.hpp"
#include "tests/faults/run_witness.hpp"
#include "tests/faults/same_face.hpp"

namespace biotomy::tests {

namespace {

namespace fs = std::filesystem;

/// Positions travel in steps of 0.1 µm.
constexpr double kStepUm = 0.11;

/// Two frames of one face differ by the rest of their noise: 0.6 levels where it is brightest.
constexpr double kMostDifference = 1.2;

/// And a JPEG with colours of half the resolution from what went into it.
constexpr double kMostDifferenceByJpeg = 3.0;

/// Of the difference to the nearest neighbour: beyond it the photograph could be of either.
constexpr double kMostOfNeighbour = 0.5;

/// Complaints under construction.
class Complaints {
 public:
  template <typename... Parts>
  void add(const Parts&... parts) {
    std::ostringstream text;
    (text << ... << parts);
    sentences_.push_back(text.str());
  }
  std::vector<std::string> take() && { return std::move(sentences_); }

 private:
  std::vector<std::string> sentences_;
};

class Judge {
 public:
  Judge(const FinishedRun& run, const fs::path& undisturbed)
      : run_(run),
        undisturbed_(reconstruct::SampleFolder::open(undisturbed)),
        sample_(reconstruct::SampleFolder::open(run.sample)),
        witness_(read_witness(run.witness)),
        journal_(read_run_journal(sample_.journal_path())) {
    for (const RunJournal::Layer& layer : journal_.layers) layers_[layer.layer] = &layer;
    for (const Killed& kill : run_.kills) stops_.push_back(kill.at);
    for (const RunJournal::Alarm& alarm : journal_.alarms) stops_.push_back(alarm.at);
    stops_.insert(stops_.end(), witness_.stops.begin(), witness_.stops.end());
    std::sort(stops_.begin(), stops_.end());
  }

  std::vector<std::string> run() && {
    for (const std::string& contradiction : witness_.contradictions) complaints_.add(contradiction);
    judge_passes();
    judge_kills();
    judge_intents();
    judge_layers();
    if (!run_.camera_streams) judge_frames();
    return std::move(complaints_).take();
  }

 private:
  /// The layer to whose face this position belongs; it may be none of the job's.
  std::int64_t layer_at(double position_um) const {
    return 1 + std::llround((position_um - run_.first_face_um) / run_.layer_thickness_um);
  }

  /// Whether something stopped the run from `begin` on and before `end`, which may be empty: never.
  bool stopped_between(const std::string& begin, const std::string& end) const {
    const auto stop = std::lower_bound(stops_.begin(), stops_.end(), begin);
    return stop != stops_.end() && (end.empty() || *stop <= end);
  }

  void judge_passes() {
    std::int64_t ground = 0;  // layers, by whole passes
    for (std::size_t i = 0; i < witness_.passes.size(); ++i) {
      const WitnessedPass& pass = witness_.passes[i];
      if (!pass.moved()) continue;
      const std::int64_t layer = layer_at(pass.target_um);
      const bool on_a_face = layer >= 1 && layer <= run_.layers &&
                             std::abs(pass.target_um - run_.face_um(layer)) <= kStepUm;
      if (!on_a_face) {
        complaints_.add("command ", pass.sequence, " ground to ", pass.target_um,
                        " µm, where no layer's face is");
        continue;
      }
      if (layer <= ground) {
        complaints_.add("layer ", layer, " was ground again by command ", pass.sequence);
        continue;
      }
      if (layer > ground + 1) {
        complaints_.add("command ", pass.sequence, " ground layer ", layer, " and layer ",
                        ground + 1, " had not been ground");
      }
      judge_commit_before(pass, layer);
      if (pass.result == "done") {
        ground = layer;
        continue;
      }
      const std::string next =
          i + 1 < witness_.passes.size() ? witness_.passes[i + 1].began_at : "";
      if (!stopped_between(pass.began_at, next)) {
        complaints_.add("the pass of command ", pass.sequence, " over layer ", layer, " ended as '",
                        pass.result, "' and nothing broke it off");
      }
    }
    if (ground < run_.layers) {
      complaints_.add("layers ", ground + 1, " to ", run_.layers, " were not ground");
    }
  }

  void judge_commit_before(const WitnessedPass& pass, std::int64_t layer) {
    if (layer == 1) return;
    const auto above = layers_.find(layer - 1);
    if (above == layers_.end()) {
      complaints_.add("layer ", layer, " was ground and layer ", layer - 1, " was never committed");
    } else if (above->second->committed_at > pass.began_at) {
      complaints_.add("layer ", layer, " was ground at ", pass.began_at, ", before layer ",
                      layer - 1, " was committed at ", above->second->committed_at);
    }
  }

  void judge_kills() {
    for (const Killed& kill : run_.kills) {
      for (const WitnessedPass& pass : witness_.passes) {
        const std::int64_t layer = layer_at(pass.target_um);
        if (pass.moved() && pass.began_at <= kill.at && layer > kill.committed + 1) {
          complaints_.add("at the kill of ", kill.at, " layer ", layer,
                          " was ground and the journal held ", kill.committed, " committed layers");
        }
      }
    }
  }

  void judge_intents() {
    std::map<std::uint32_t, const RunJournal::Grind*> intents;
    std::int64_t last = 0;
    for (const RunJournal::Grind& grind : journal_.grinds) {
      intents[grind.sequence] = &grind;
      if (grind.layer < last) {
        complaints_.add("command ", grind.sequence, " was meant for layer ", grind.layer,
                        " after one for layer ", last);
      }
      last = std::max(last, grind.layer);
    }
    for (const WitnessedPass& pass : witness_.passes) {
      const auto intent = intents.find(pass.sequence);
      if (intent == intents.end() ||
          std::abs(intent->second->target_um - pass.target_um) > kStepUm) {
        complaints_.add("command ", pass.sequence, " ground to ", pass.target_um,
                        " µm and the journal does not know of it");
      } else if (intent->second->intended_at > pass.began_at) {
        complaints_.add("command ", pass.sequence, " began at ", pass.began_at,
                        " and was in the journal only at ", intent->second->intended_at);
      }
    }
  }

  void judge_layers() {
    for (std::int64_t layer = 1; layer <= run_.layers; ++layer) {
      const auto found = layers_.find(layer);
      if (found == layers_.end()) {
        complaints_.add("layer ", layer, " is not committed");
        continue;
      }
      judge_file(*found->second);
    }
    if (!layers_.empty() && layers_.rbegin()->first > run_.layers) {
      complaints_.add("layer ", layers_.rbegin()->first, " is committed and the job has ",
                      run_.layers);
    }
  }

  void judge_file(const RunJournal::Layer& layer) {
    const fs::path file = sample_.path() / layer.file;
    std::error_code error;
    if (file != sample_.layer_path(layer.layer) || !fs::is_regular_file(file, error)) {
      complaints_.add("the file of layer ", layer.layer, " is missing");
      return;
    }
    if (fs::file_size(file) != layer.bytes || reconstruct::sha256_of_file(file) != layer.sha256) {
      complaints_.add("the file of layer ", layer.layer, " is not what was committed");
      return;
    }
    judge_image(layer.layer, reconstruct::read_layer_image(file));
  }

  cv::Mat undisturbed(std::int64_t layer) const {
    return reconstruct::read_layer_image(undisturbed_.layer_path(layer));
  }

  void judge_image(std::int64_t layer, const cv::Mat& image) {
    const double difference = face_difference(image, undisturbed(layer));
    double to_neighbour = 1e9;
    for (const std::int64_t neighbour : {layer - 1, layer + 1}) {
      if (neighbour < 1 || neighbour > run_.layers) continue;
      to_neighbour = std::min(to_neighbour, face_difference(image, undisturbed(neighbour)));
    }
    const double most = run_.camera_streams ? kMostDifferenceByJpeg : kMostDifference;
    if (difference > most || difference > kMostOfNeighbour * to_neighbour) {
      complaints_.add("the image of layer ", layer, " differs by ", difference,
                      " levels from the undisturbed run's, which differs by ", to_neighbour,
                      " from the layer next to it");
    }
  }

  /// The last frame that was taken up to `at` and suits, of those that have no record yet.
  template <typename Suits>
  std::optional<std::size_t> last_frame_until(const std::string& at, Suits suits) const {
    std::optional<std::size_t> last;
    for (std::size_t i = 0; i < witness_.frames.size(); ++i) {
      const WitnessedFrame& frame = witness_.frames[i];
      if (!recorded_[i] && frame.at <= at && suits(frame)) last = i;
    }
    return last;
  }

  /// Of a number there is one since each start of the twin.
  std::optional<std::size_t> last_frame_of(std::uint64_t number, const std::string& until) const {
    return last_frame_until(
        until, [number](const WitnessedFrame& frame) { return frame.number == number; });
  }

  /// A camera that gives an old picture may give it under its old number.
  std::optional<std::size_t> last_spoilt_frame(const std::string& until) const {
    return last_frame_until(until, [](const WitnessedFrame& frame) { return frame.spoilt; });
  }

  void match_trials() {
    for (const RunJournal::Trial& trial : journal_.trials) {
      if (const auto match = last_frame_of(trial.frame, trial.at)) {
        recorded_[*match] = true;
      } else {
        complaints_.add("the trial frame ", trial.frame, " of ", trial.at,
                        " was not taken by the twin");
      }
    }
  }

  void match_attempts() {
    for (const RunJournal::Attempt& attempt : journal_.attempts) {
      auto match = last_frame_of(attempt.frame, attempt.taken_at);
      if (!match && attempt.verdict == "rejected") match = last_spoilt_frame(attempt.taken_at);
      if (!match) {
        complaints_.add("attempt ", attempt.attempt, " at layer ", attempt.layer, " shows frame ",
                        attempt.frame, ", which the twin did not take then");
        continue;
      }
      recorded_[*match] = true;
      judge_attempt(attempt, witness_.frames[*match]);
    }
  }

  /// The frames from `first` on that show, in its order, what a search measured until its record.
  std::vector<std::size_t> frames_from(std::size_t first, const RunJournal::Search& search) const {
    std::vector<std::size_t> found;
    for (std::size_t i = first; i < recorded_.size() && found.size() < search.columns_um.size();
         ++i) {
      const WitnessedFrame& frame = witness_.frames[i];
      if (recorded_[i] || frame.at > search.at || layer_at(frame.face_um) != search.layer) continue;
      const double column_um = search.columns_um[found.size()];
      if (std::abs(frame.column_um - column_um) <= kStepUm) found.push_back(i);
    }
    return found;
  }

  /// Two frames at one place of the column are told apart by the order in which they were taken.
  void match_searches() {
    for (const RunJournal::Search& search : journal_.searches) {
      std::vector<std::size_t> found;
      for (std::size_t first = recorded_.size();
           first-- > 0 && found.size() < search.columns_um.size();) {
        std::vector<std::size_t> from_here = frames_from(first, search);
        if (from_here.size() > found.size()) found = std::move(from_here);
      }
      for (const std::size_t i : found) recorded_[i] = true;
      if (found.size() == search.columns_um.size()) continue;
      complaints_.add("the search of ", search.at, " at layer ", search.layer,
                      " measured a frame at ", search.columns_um[found.size()],
                      " µm of the column, which the twin did not take");
    }
  }

  void judge_attempt(const RunJournal::Attempt& attempt, const WitnessedFrame& frame) {
    const auto layer = layers_.find(attempt.layer);
    if (layer == layers_.end() || layer->second->attempt != attempt.attempt) return;
    if (!frame.face_in_view || !frame.lamp_on ||
        std::abs(frame.face_um - run_.face_um(attempt.layer)) > run_.layer_thickness_um / 4.0) {
      complaints_.add("the image of layer ", attempt.layer, " was taken of the face at ",
                      frame.face_um, " µm", frame.lamp_on ? "" : ", in the dark",
                      frame.face_in_view ? "" : ", while the block was away");
    }
  }

  /// Where a frame came too late, or never, the journal says so: of one each time. It was taken
  /// just before, or just after: what made it late may have been the taking.
  void match_lost_frames() {
    for (const std::string& told : journal_.no_frame_at) {
      const auto after = std::find_if(witness_.frames.begin(), witness_.frames.end(),
                                      [&](const WitnessedFrame& frame) { return frame.at > told; });
      const auto next = static_cast<std::size_t>(after - witness_.frames.begin());
      if (next > 0 && !recorded_[next - 1]) {
        recorded_[next - 1] = true;
      } else if (next < recorded_.size()) {
        recorded_[next] = true;
      }
    }
  }

  void judge_frames() {
    recorded_.assign(witness_.frames.size(), false);
    match_trials();
    match_attempts();
    match_searches();
    match_lost_frames();
    for (std::size_t i = 0; i < witness_.frames.size(); ++i) {
      const WitnessedFrame& frame = witness_.frames[i];
      if (recorded_[i] || was_lost_by_a_stop(i)) continue;
      complaints_.add("frame ", frame.number, " of ", frame.at, ", of layer ",
                      layer_at(frame.face_um), ", has no record");
    }
  }

  /// A search that a kill broke off is not recorded, and its last frame is lost, whatever it was
  /// of.
  bool was_lost_by_a_stop(std::size_t place) const {
    const WitnessedFrame& frame = witness_.frames[place];
    std::string next_recorded;
    for (std::size_t i = place + 1; i < witness_.frames.size() && next_recorded.empty(); ++i) {
      if (recorded_[i]) next_recorded = witness_.frames[i].at;
    }
    if (!stopped_between(frame.at, next_recorded)) return false;
    const std::string stop = *std::lower_bound(stops_.begin(), stops_.end(), frame.at);
    const bool is_last =
        place + 1 == witness_.frames.size() || witness_.frames[place + 1].at > stop;
    const auto between = [&](const std::string& at) {
      return at >= frame.at && (next_recorded.empty() || at <= next_recorded);
    };
    const bool killed = std::any_of(run_.kills.begin(), run_.kills.end(),
                                    [&](const Killed& kill) { return between(kill.at); });
    return killed && (is_last || frame.column_moved_next);
  }

  const FinishedRun& run_;
  reconstruct::SampleFolder undisturbed_;
  reconstruct::SampleFolder sample_;
  Witness witness_;
  RunJournal journal_;
  std::map<std::int64_t, const RunJournal::Layer*> layers_;
  std::vector<std::string> stops_;
  std::vector<bool> recorded_;  ///< of each frame: in a trial, an attempt or a search
  Complaints complaints_;
};

}  // namespace

std::vector<std::string> judge(const FinishedRun& run, const fs::path& undisturbed_sample) {
  return Judge(run, undisturbed_sample).run();
}

}  // namespace biotomy::tests
