#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "acquisition/records/journal_rows.hpp"
#include "acquisition/records/layer_journal.hpp"
#include "acquisition/records/rejected_frames.hpp"
#include "acquisition/records/surroundings.hpp"
#include "acquisition/settings/job_plan.hpp"
#include "firmware_bridge/camera/camera.hpp"
#include "firmware_bridge/camera/frame.hpp"
#include "reconstruct/sample/layer_image.hpp"
#include "reconstruct/sample/sample_folder.hpp"

namespace biotomy::acquisition {

/// A frame that was judged, with what belongs into its record.
struct JudgedFrame {
  bridge::Frame frame;
  Assessment assessment;
  std::int64_t layer = 0;
  int attempt = 0;
  std::string taken_at;
  std::chrono::nanoseconds asked_at{0};  ///< the camera was, CLOCK_MONOTONIC
  bridge::Micrometres column{};
  bridge::StageStatus telemetry;
  reconstruct::PublishLayer prepared = {};  ///< its layer; empty if nobody has prepared it
  bool is_recorded = false;                 ///< in the journal, as one that could not be stored
};

/// All that is written of a sample but the volume: layer images, rejected frames, the journal.
/// The worker's thread owns it.
class SampleRecords {
 public:
  /// Begins the sample, or opens it when it is there: then it must be of the same size, spacing and
  /// depth, and every committed layer's file must be there with the recorded size.
  /// Throws SampleError and JournalError.
  SampleRecords(const JobPlan& plan, const StorePlan& store,
                const bridge::CameraDescription& camera, Surroundings surroundings);

  const reconstruct::SampleFolder& sample() const { return sample_; }
  JournalSummary summary() const { return journal_.summary(); }

  /// What is the same for all layers: recorded before the first one is committed, afterwards only
  /// compared. Throws SampleError for a difference.
  void hold_constant(const std::vector<Constant>& constants);

  void begin_grind(const GrindRow& grind);
  void end_grind(std::uint32_t sequence, bridge::CommandResult result,
                 const bridge::StageStatus& telemetry);
  void record_focus(const FocusRow& focus);
  void record_event(const JobEventRow& event);

  /// Keeps a small picture and the record of a frame that is not the layer.
  void record_rejected(const JudgedFrame& frame);

  /// All of storing a frame's layer that may be done before it is accepted. What goes wrong comes
  /// out when it is published. Any thread may call it while the records are there.
  reconstruct::PublishLayer prepare_layer(const JudgedFrame& frame) const;

  /// Stores the layer durably, prepared or not, then commits its record. Gives the bytes of the
  /// file. When the image could not be stored, the frame is recorded as `not_stored` and the error
  /// goes on. Either way nothing prepared is left in `frame`, to be given up by another thread.
  std::uint64_t commit_layer(JudgedFrame& frame);

  /// The time as records have it: ISO 8601, UTC.
  std::string now() const;

  /// How many more layers fit onto the disk, each counted with its part of the volume.
  std::int64_t disk_left_layers() const;

 private:
  AttemptRow row_of(const JudgedFrame& frame) const;

  reconstruct::SampleFolder sample_;
  StorePlan store_;
  Surroundings surroundings_;
  LayerJournal journal_;
  RejectedFrames rejected_;
  std::uint64_t bytes_per_layer_;
};

}  // namespace biotomy::acquisition
