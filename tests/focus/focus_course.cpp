#include "tests/focus/focus_course.hpp"

#include <algorithm>
#include <cmath>
#include <memory>

#include "acquisition/focus/depth_of_field.hpp"
#include "acquisition/job/focus_step.hpp"
#include "acquisition/quality/judgement.hpp"
#include "acquisition/quality/noise_judgement.hpp"
#include "acquisition/quality/sharpness_judgement.hpp"
#include "acquisition/records/sample_records.hpp"
#include "acquisition/rig/column_actuator.hpp"
#include "acquisition/rig/lens_actuator.hpp"
#include "tests/focus/twin_optics.hpp"
#include "tests/temporary_folder.hpp"

namespace biotomy::tests {

namespace {

using namespace acquisition;

constexpr double kGuessErrorUm = 150.0;  ///< the operator's guess is near, not right

/// Does what is posted at once.
struct AtOnce : Worker {
  void post(std::function<void()> task) override { task(); }
};

JobSettings settings_of(const FocusCourse& course, const TwinOptics& optics,
                        const std::filesystem::path& sample) {
  JobSettings settings;
  settings.plan.sample = sample;
  settings.plan.name = "course";
  settings.plan.layers = course.layers;
  settings.plan.layer_thickness = {course.layer_thickness_um};
  settings.focus.actuator =
      course.lens ? FocusSettings::Actuator::lens : FocusSettings::Actuator::column;
  settings.focus.start = {optics.sharp_at_um() + kGuessErrorUm};
  settings.focus.depth_of_field = depth_of_field({.numerical_aperture = 0.1});
  settings.focus.step = 0.5 * settings.focus.depth_of_field;
  settings.focus.largest_change = settings.focus.depth_of_field;
  return settings;
}

/// The daemon's focus step with all that it needs, and nothing of the rest of the job.
class Bench {
 public:
  explicit Bench(const FocusCourse& course)
      : optics_(course),
        column_(optics_),
        camera_(optics_, course.lens),
        settings_(settings_of(course, optics_, folder_ / "sample")),
        keeper_(worker_, std::make_shared<SampleRecords>(settings_.plan, settings_.store,
                                                         camera_.describe(), real_surroundings())),
        commands_(column_, settings_.limits),
        memory_(settings_.focus, settings_.plan.layer_thickness),
        step_(settings_, actuator(), memory_, camera_, worker_, keeper_) {}

  /// Focuses on a layer and takes its frame, as the job does; once more when it is blurred.
  void do_layer(int layer, FocusOutcome& outcome) {
    optics_.begin_layer(layer);
    Assessment frame = focus(layer, {memory_.why_search(layer), false}, outcome);
    if (frame.verdict != Verdict::accepted) {
      ++outcome.taken_again;
      outcome.misses_um.pop_back();
      memory_.take_back();
      frame = focus(layer, {"the quality ladder asked for it", true}, outcome);
    }
    record_.accept(frame.measures);
    if (frame.noise) record_.know_noise(*frame.noise);
    memory_.keep();
    if (frame.sharpness_to_peak) memory_.accepted(*frame.sharpness_to_peak);
  }

 private:
  /// Gives what the daemon thinks of the frame's sharpness.
  Assessment focus(int layer, SearchReason reason, FocusOutcome& outcome) {
    const int before = optics_.photographs;
    const TimePoint now{};
    step_.begin(layer, reason, record_.noise(), now);
    while (!step_.poll(column_.exchange(0), now)) {
      outcome.farthest_um = std::max(outcome.farthest_um,
                                     std::abs(optics_.mover.position_um() - optics_.sharp_at_um()));
    }
    const int frames = optics_.photographs - before;
    outcome.focus_frames += frames;
    outcome.most_frames = std::max(outcome.most_frames, frames);
    outcome.searches += reason.words != nullptr ? 1 : 0;
    outcome.found += reason.words != nullptr && step_.last_search()->found ? 1 : 0;

    const sim::Photograph photograph = optics_.photograph();
    outcome.misses_um.push_back(photograph.defocus_um);
    record_.found_focus(memory_.peak_layer(), memory_.peak_measures());
    Judgement judgement;
    judgement.result().measures =
        std::make_shared<const FrameMeasures>(measure_frame(photograph.image));
    judge_noise(layer, record_, judgement);
    judge_sharpness(record_, layer, settings_.thresholds, judgement);
    return judgement.finish();
  }

  std::unique_ptr<FocusActuator> actuator() {
    if (settings_.focus.actuator == FocusSettings::Actuator::column) {
      return std::make_unique<ColumnActuator>(commands_, settings_.limits,
                                              column_.identify().column);
    }
    return std::make_unique<LensActuator>(camera_, settings_.camera.settings,
                                          *camera_.describe().lens, worker_);
  }

  TemporaryFolder folder_;
  TwinOptics optics_;
  TwinColumn column_;
  TwinCamera camera_;
  JobSettings settings_;
  AtOnce worker_;
  RecordKeeper keeper_;
  StageCommands commands_;
  FocusMemory memory_;
  FocusStep step_;
  SharpnessRecord record_;
};

}  // namespace

std::vector<FocusCourse> focus_courses() {
  return {
      {.name = "level face", .seed = 1},
      {.name = "tilted face, fast content",
       .seed = 2,
       .content_um = 300.0,
       .tilt_across_um = 60.0,
       .tilt_down_um = -40.0,
       .drift_um = -0.8},
      {.name = "little light: gain 4", .seed = 3, .tilt_across_um = -50.0, .gain = 4.0},
      {.name = "edge of the specimen, nearly empty faces",
       .seed = 4,
       .specimen_um = 20000.0,
       .drift_um = -0.5},
      {.name = "knocked by 300 µm half-way", .seed = 6, .knock_um = 300.0},
      {.name = "lens in place of the column",
       .seed = 5,
       .tilt_down_um = 50.0,
       .drift_um = 0.8,
       .lens = true},
      {.name = "camera with one chip", .seed = 3, .tilt_across_um = 30.0, .mosaic = true},
      {.name = "one chip, nearly empty faces", .seed = 2, .specimen_um = 14000.0, .mosaic = true}};
}

double course_depth_of_field_um() {
  constexpr double kApertureOfTheTwin = 0.1;
  return depth_of_field({.numerical_aperture = kApertureOfTheTwin, .pixel = {0.0}}).value;
}

FocusOutcome run(const FocusCourse& course) {
  FocusOutcome outcome{.name = course.name, .misses_um = {}};
  Bench bench(course);
  for (int layer = 1; layer <= course.layers; ++layer) bench.do_layer(layer, outcome);
  return outcome;
}

}  // namespace biotomy::tests
