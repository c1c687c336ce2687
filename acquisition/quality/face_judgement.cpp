#include "acquisition/quality/face_judgement.hpp"

#include <algorithm>
#include <functional>
#include <string>

namespace biotomy::acquisition {
namespace {

/// A limit that lies within so many standard deviations of no change at all can't be judged by.
constexpr double kCertain = 3.0;

/// A row or column of patches shows the former face when it changed less than this part of the
/// least that it has changed lately. Smaller than that of the whole face: a few patches vary more.
constexpr double kOldLine = 0.1;

std::string number(std::uint64_t value) {
  return std::to_string(value);
}

/// How much of the frame, from its first line on, still shows the former face: up to the last line
/// of those that do without one between them that changed. Lines that can't be judged lie on either
/// side.
template <typename Lines, typename LeastChange>
double old_share(const Lines& lines, const LeastChange& least_change, bool from_the_end) {
  std::size_t old = 0;
  bool somewhere_new = false;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const std::size_t line = from_the_end ? lines.size() - 1 - i : i;
    const std::optional<double> least = least_change(line);
    if (!lines[line] || !least) continue;
    const double limit = kOldLine * *least;
    if (limit < kCertain * lines[line]->error) continue;
    if (lines[line]->value >= limit) {
      somewhere_new = true;
    } else if (!somewhere_new) {
      old = i + 1;
    }
  }
  // All of it old is a face that did not change.
  return somewhere_new ? static_cast<double>(old) / static_cast<double>(lines.size()) : 0.0;
}

struct OldPart {
  double share = 0.0;
  const char* where = "";
  const char* slug = "";
  const char* cause = "";
};

OldPart find_old_part(const FaceChange& change, const FaceRecord& faces) {
  const auto of_row = [&](std::size_t row) { return faces.least_change_of_row(row); };
  const auto of_column = [&](std::size_t column) { return faces.least_change_of_column(column); };
  const char* const torn = "the frame is torn, or the grind left that part";
  const char* const left = "the grind left that part";
  OldPart most;
  for (const OldPart& part :
       {OldPart{old_share(change.rows, of_row, false), "upper", "torn", torn},
        OldPart{old_share(change.rows, of_row, true), "lower", "torn", torn},
        OldPart{old_share(change.columns, of_column, false), "left", "part-unchanged", left},
        OldPart{old_share(change.columns, of_column, true), "right", "part-unchanged", left}}) {
    if (part.share > most.share) most = part;
  }
  return most;
}

}  // namespace

void judge_moment(const bridge::Frame& frame, const FrameExpectation& expectation,
                  Judgement& judgement) {
  const auto stale = [&](const std::string& reason) {
    judgement.reject("stale", reason);
    judgement.result().shows_the_face = false;
  };
  const std::chrono::nanoseconds taken = frame.sensor_timestamp;
  // A camera that was begun anew counts anew, and may come to the same number.
  const bool is_younger =
      expectation.previous_timestamp.count() != 0 && taken > expectation.previous_timestamp;
  if (!is_younger && expectation.previous_sequence &&
      frame.sequence == *expectation.previous_sequence) {
    stale("the camera gave frame " + number(frame.sequence) + " again: it is of an earlier moment");
  }
  if (taken.count() == 0) return;  // the camera doesn't say
  using Milliseconds = std::chrono::duration<double, std::milli>;
  if (expectation.asked_at.count() != 0 && taken < expectation.asked_at) {
    stale("frame " + number(frame.sequence) + " was exposed " +
          std::to_string(Milliseconds(expectation.asked_at - taken).count()) +
          " ms before the camera was asked for it: it is of an earlier moment");
  }
  if (expectation.previous_timestamp.count() != 0 && taken <= expectation.previous_timestamp) {
    stale("frame " + number(frame.sequence) +
          " was not exposed after the frame before it: it is of an earlier moment");
  }
}

void judge_rows(const FaceRecord& faces, const QualityThresholds& thresholds,
                Judgement& judgement) {
  const FrameRows& rows = *judgement.result().face->frame_rows;
  const FrameRows* reference = faces.face() != nullptr ? faces.face()->frame_rows.get() : nullptr;
  const bool alive = judgement.at_most(
      "dead_rows", dead_share(rows, reference), thresholds.maximum_dead_rows, "partial",
      "%.3f of the frame's rows hold one value all along, more than %.3f: the "
      "frame is not complete");

  double repeated = 0.0;
  for (const auto& earlier : faces.recent_frames()) {
    const RepeatedRows count = repeated_rows(rows, *earlier);
    if (count.noisy == 0) break;
    repeated = std::max(repeated, static_cast<double>(count.repeated) / count.noisy);
  }
  constexpr double kWhole = 0.99;
  const bool fresh = judgement.at_most(
      "repeated_rows", repeated, thresholds.maximum_repeated_rows,
      repeated >= kWhole ? "stale" : "torn",
      repeated >= kWhole
          ? "%.3f of the frame's rows are, bit for bit, an earlier frame's, more than %.3f: the "
            "camera gave an old picture again"
          : "%.3f of the frame's rows are, bit for bit, an earlier frame's, more than %.3f: the "
            "frame is torn");
  if (!alive || !fresh) judgement.result().shows_the_face = false;
}

bool judge_face_change(const FaceRecord& faces, const std::optional<BandNoise>& noise,
                       const QualityThresholds& thresholds, Judgement& judgement) {
  if (faces.face() == nullptr || thresholds.minimum_face_change <= 0.0) return true;
  Assessment& result = judgement.result();
  result.face_change = measure_face_change(*result.face, *faces.face(), noise);

  const double least = faces.least_change().value_or(0.0);
  const double limit =
      std::max(thresholds.minimum_face_change, thresholds.minimum_face_change_ratio * least);
  const std::optional<Change>& whole = result.face_change.whole;
  const std::string before = "layer " + std::to_string(faces.layer()) + "'s";
  if (!whole) {
    judgement.leave_open("too little detail to tell the face from " + before);
    return false;
  }
  if (limit < kCertain * whole->error) {
    judgement.leave_open("too much noise to tell the face from " + before);
    return false;
  }
  const std::string unchanged =
      "the face did not change: %.4f of its detail differs from " + before +
      ", less than %.4f; the grind removed nothing, or the camera gave an old picture";
  // An old picture shows an old face and says nothing of the one under the camera.
  const bool is_fresh = result.shows_the_face;
  const bool changed =
      judgement.at_least(kFaceChange, whole->value, limit, "face-unchanged", unchanged.c_str());
  result.face_changed = changed || !is_fresh;
  const OldPart old = find_old_part(result.face_change, faces);
  const std::string torn = "the " + std::string(old.where) + " %.3f of the frame still shows " +
                           before + " face, more than %.3f: " + old.cause;
  const bool all_new =
      judgement.at_most("old_part", old.share, thresholds.maximum_old_part, old.slug, torn.c_str());
  if (!changed || !all_new) result.shows_the_face = false;
  return true;
}

}  // namespace biotomy::acquisition
