#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "acquisition/focus/face_lean.hpp"
#include "acquisition/quality/assessment.hpp"
#include "firmware_bridge/micrometres.hpp"
#include "firmware_bridge/stage/stage.hpp"

namespace biotomy::acquisition {

/// One pass of the wheel. It is written down before the command is issued.
struct GrindRow {
  std::uint32_t sequence = 0;
  std::int64_t layer = 0;
  bridge::Micrometres target{};
  bridge::Micrometres ground_before{};  ///< the controller's `ground_position` before
  std::int64_t count_before = 0;        ///< the controller's `grind_count` before
  bool finished = false;
};

/// One frame that was taken and judged.
struct AttemptRow {
  std::int64_t layer = 0;
  int attempt = 0;  ///< from 1 within the layer
  std::string taken_at;
  std::uint64_t frame_sequence = 0;
  std::int64_t exposure_us = 0;
  double gain = 0.0;
  bridge::Micrometres column{};
  Assessment assessment;
  std::string file;    ///< relative to the sample folder; empty if none was kept
  std::string sha256;  ///< of the file
  bridge::StageStatus telemetry;
};

/// What the journal says of an attempt, without the telemetry.
struct AttemptNote {
  std::int64_t id = 0;  ///< grows from attempt to attempt of a journal
  std::int64_t layer = 0;
  int attempt = 0;
  std::string taken_at;
  std::int64_t exposure_us = 0;
  double gain = 0.0;
  bridge::Micrometres column{};
  std::string verdict;  ///< as to_string(Verdict) names it
  std::string slug;     ///< of the reason: one word for programs
  std::string reason;
  std::string file;  ///< relative to the sample folder; empty if none was kept
  std::vector<Metric> metrics;
};

/// Attempts column by column, as charts want them: entry i of each belongs to one attempt.
struct AttemptHistory {
  struct Column {
    std::string name;
    std::vector<std::optional<double>> value;  ///< none where the attempt has no such metric
    std::vector<std::optional<double>> limit;
  };
  std::vector<std::int64_t> id;
  std::vector<std::int64_t> layer;
  std::vector<int> attempt;
  std::vector<std::string> verdict;
  std::vector<double> column_um;
  std::vector<std::string> taken_at;
  std::vector<Column> metrics;
};

/// One search for the focus.
struct FocusRow {
  std::int64_t layer = 0;
  std::string why;               ///< and what broke it off, if something did
  bridge::Micrometres column{};  ///< the plane in focus, or where it was expected
  double sharpness = 0.0;        ///< there
  bool found = false;
  struct Point {
    bridge::Micrometres column{};
    double sharpness = 0.0;
  };
  std::vector<Point> points;       ///< every frame that was taken; of a focus that was found
                                   ///< the confirming one last
  std::optional<FaceLean> lean{};  ///< where enough of the face shows detail
};

/// Something that happened in a job.
struct JobEventRow {
  std::string kind;   ///< "state", "alarm", "operator", "recovery"
  std::string state;  ///< of the job at that time
  std::int64_t layer = 0;
  std::string text;
  std::string at;  ///< ISO 8601, UTC
};

/// So begins the text of the event by which a job says at which layer it starts; the number
/// follows.
inline constexpr std::string_view kGoesOnWithLayer = "goes on with layer ";

/// A layer whose image is on disk and whose record is committed.
struct LayerRow {
  std::int64_t layer = 0;
  int attempt = 0;
  bool flagged = false;  ///< accepted although the quality was not good enough
  std::string file;      ///< relative to the sample folder
  std::uint64_t bytes = 0;
  std::string sha256;
  std::string committed_at;
  std::string reason;  ///< of the verdict
  std::vector<Metric> metrics;
};

/// Something that is the same for all layers of a sample.
struct Constant {
  std::string name;   ///< a key of the configuration
  std::string value;  ///< as text, for a person to read

  friend bool operator==(const Constant&, const Constant&) = default;
};

/// What the job must know of its own past.
struct JournalSummary {
  std::int64_t last_committed = 0;  ///< layers 1 to this one are committed
  int last_attempt = 0;             ///< of the first layer that is not
  std::uint32_t last_sequence = 0;
  std::uint64_t last_layer_bytes = 0;
  int flagged_in_a_row = 0;   ///< layers up to the last committed one
  std::string last_event_at;  ///< of a job, not of a daemon's start; ISO 8601, UTC; empty if none
  std::optional<GrindRow> last_grind;
  /// The last that was found and led to a stored layer; without its points.
  std::optional<FocusRow> last_focus;
  bool focus_in_doubt = false;  ///< searches for the first layer that is not committed gave none
  std::vector<Constant> constants;  ///< by their names; none in journals of older daemons
};

}  // namespace biotomy::acquisition
