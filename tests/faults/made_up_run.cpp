#include "tests/faults/made_up_run.hpp"

#include <chrono>
#include <fstream>
#include <utility>

#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "acquisition/records/utc_time.hpp"
#include "reconstruct/sample/layer_image.hpp"

namespace biotomy::tests {
namespace {

using nlohmann::json;

constexpr int kWidth = 64;
constexpr int kHeight = 48;

}  // namespace

double MadeUpRun::face_um(std::int64_t layer) {
  return kFirstFaceUm + static_cast<double>(layer - 1) * kThicknessUm;
}

cv::Mat MadeUpRun::photograph(std::int64_t layer, int noise) {
  cv::RNG random(static_cast<std::uint64_t>(layer));
  cv::Mat coarse(kHeight / 8, kWidth / 8, CV_8UC3);
  random.fill(coarse, cv::RNG::UNIFORM, 90, 140);
  cv::Mat image;
  cv::resize(coarse, image, {kWidth, kHeight}, 0, 0, cv::INTER_CUBIC);
  cv::RNG grain(static_cast<std::uint64_t>(noise));
  cv::Mat speckle(image.size(), CV_16SC3);
  grain.fill(speckle, cv::RNG::NORMAL, 0, 1.6);
  cv::add(image, speckle, image, cv::noArray(), CV_8UC3);
  return image;
}

reconstruct::SampleFolder MadeUpRun::new_sample(const std::filesystem::path& folder) {
  reconstruct::SampleDescription description;
  description.name = "made up";
  description.cuboid = {.size = {kWidth, kHeight, kLayers}, .spacing = {10.0, 10.0, kThicknessUm}};
  return reconstruct::SampleFolder::create(folder, description);
}

MadeUpRun::MadeUpRun(const std::filesystem::path& folder)
    : folder_(folder), sample_(new_sample(folder / "sample")), journal_(sample_.journal_path()) {
  start_twin("none");
}

std::string MadeUpRun::now() {
  return acquisition::utc_text(
      std::chrono::system_clock::time_point(std::chrono::seconds(++second_)));
}

void MadeUpRun::witness(const char* event, json facts) {
  facts["time"] = now();
  facts["event"] = event;
  std::ofstream(folder_ / "witness.jsonl", std::ios::app) << facts.dump() << '\n';
}

void MadeUpRun::start_twin(const char* result) {
  frame_ = 0;
  witness("twin_started", {{"sequence", sequence_}, {"result", result}});
}

void MadeUpRun::intend(std::int64_t layer) {
  journal_.begin_grind({.sequence = ++sequence_, .layer = layer, .target = {face_um(layer)}},
                       now());
}

void MadeUpRun::begin_pass(std::int64_t layer) {
  witness("command_started",
          {{"sequence", sequence_}, {"action", "grind_pass"}, {"position_um", face_um(layer)}});
}

void MadeUpRun::end_pass(const char* result) {
  witness("command_finished",
          {{"sequence", sequence_}, {"action", "grind_pass"}, {"result", result}});
}

void MadeUpRun::grind(std::int64_t layer) {
  intend(layer);
  begin_pass(layer);
  end_pass("done");
}

void MadeUpRun::move_column() {
  witness("command_started", {{"sequence", 0}, {"action", "move_column"}});
}

void MadeUpRun::take_frame(std::int64_t layer, double column_um, bool spoilt) {
  witness("capture", {{"number", ++frame_},
                      {"face_um", face_um(layer) + 0.4},
                      {"column_um", column_um},
                      {"face_in_view", true},
                      {"lamp_on", lamp_on_},
                      {"spoilt", spoilt}});
}

void MadeUpRun::reject(std::int64_t layer, std::uint64_t frame) {
  acquisition::AttemptRow row;
  row.layer = layer;
  row.attempt = ++attempt_;
  row.taken_at = now();
  row.frame_sequence = frame;
  row.assessment.verdict = acquisition::Verdict::rejected;
  journal_.record_attempt(row);
}

void MadeUpRun::commit(std::int64_t layer, std::int64_t shown) {
  const auto path = sample_.layer_path(layer);
  const auto stored = reconstruct::write_layer_image(
      path, photograph(shown, ++noise_), {layer, sample_.description().cuboid.spacing}, {});
  acquisition::AttemptRow row;
  row.layer = layer;
  row.attempt = ++attempt_;
  row.taken_at = now();
  row.frame_sequence = static_cast<std::uint64_t>(frame_);
  row.file = std::filesystem::relative(path, sample_.path());
  row.sha256 = stored.sha256;
  row.assessment.verdict = acquisition::Verdict::accepted;
  journal_.commit_layer(row, stored.bytes, now());
}

void MadeUpRun::make(std::int64_t layer) {
  grind(layer);
  take_frame(layer);
  commit(layer);
}

void MadeUpRun::make_from(std::int64_t layer) {
  for (; layer <= kLayers; ++layer) make(layer);
}

void MadeUpRun::record_search(std::int64_t layer, const std::vector<double>& columns_um) {
  acquisition::FocusRow row;
  row.layer = layer;
  row.found = true;
  for (const double column_um : columns_um) row.points.push_back({{column_um}, 0.1});
  journal_.record_focus(row, now());
}

void MadeUpRun::note(const char* kind, const char* text, const char* state) {
  journal_.record_event({.kind = kind, .state = state, .layer = 1, .text = text, .at = now()});
}

FinishedRun MadeUpRun::finished() const {
  return {folder_ / "witness.jsonl", sample_.path(), kLayers, kFirstFaceUm, kThicknessUm, kills_};
}

}  // namespace biotomy::tests
