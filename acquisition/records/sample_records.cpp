#include "acquisition/records/sample_records.hpp"

#include <exception>
#include <utility>

#include "acquisition/records/journal_reader.hpp"
#include "acquisition/records/sample_fit.hpp"
#include "acquisition/records/utc_time.hpp"
#include "reconstruct/disk/temporary_file.hpp"
#include "reconstruct/errors.hpp"

namespace biotomy::acquisition {
namespace {

using reconstruct::SampleError;
using reconstruct::SampleFolder;

SampleFolder open_or_create(const JobPlan& plan, const bridge::CameraDescription& camera,
                            const std::string& now) {
  if (SampleFolder::can_begin(plan.sample)) {
    return SampleFolder::create(plan.sample, description_of(plan, camera, now));
  }
  SampleFolder sample = SampleFolder::open(plan.sample);
  if (const auto complaint = sample_complaint(sample, plan, camera)) throw SampleError(*complaint);
  return sample;
}

}  // namespace

SampleRecords::SampleRecords(const JobPlan& plan, const StorePlan& store,
                             const bridge::CameraDescription& camera, Surroundings surroundings)
    : sample_(open_or_create(plan, camera, utc_text(surroundings.wall_clock()))),
      store_(store),
      surroundings_(std::move(surroundings)),
      journal_(sample_.journal_path()),
      rejected_(sample_.rejected_path(), store.rejected_frames, store.rejected_width_px),
      bytes_per_layer_(bytes_of_a_layer(plan, camera)) {
  const auto complaint = committed_files_complaint(sample_, JournalReader(sample_.journal_path()));
  if (complaint) throw SampleError(*complaint);
  // The lock on the sample keeps others out: what is unfinished there is of a daemon that was
  // killed.
  reconstruct::remove_unfinished_writes(sample_.layer_path(1).parent_path());
  reconstruct::remove_unfinished_writes(sample_.rejected_path());
}

void SampleRecords::hold_constant(const std::vector<Constant>& constants) {
  const JournalSummary known = journal_.summary();
  if (!holds_constants(known)) {
    journal_.record_constants(constants);
    return;
  }
  if (const auto complaint = constants_complaint(known, constants)) throw SampleError(*complaint);
}

void SampleRecords::begin_grind(const GrindRow& grind) {
  journal_.begin_grind(grind, now());
}

void SampleRecords::end_grind(std::uint32_t sequence, bridge::CommandResult result,
                              const bridge::StageStatus& telemetry) {
  journal_.end_grind(sequence, result, telemetry, now());
}

void SampleRecords::record_focus(const FocusRow& focus) {
  journal_.record_focus(focus, now());
}

void SampleRecords::record_event(const JobEventRow& event) {
  journal_.record_event(event);
}

// The frame has its record also when its picture cannot be kept.
void SampleRecords::record_rejected(const JudgedFrame& frame) {
  AttemptRow row = row_of(frame);
  std::exception_ptr failure;
  try {
    if (!frame.frame.image.empty()) {
      const std::filesystem::path file =
          rejected_.add(frame.layer, frame.attempt, frame.assessment.slug, frame.frame.image);
      row.file = std::filesystem::relative(file, sample_.path()).string();
    }
  } catch (const std::exception& error) {
    row.assessment.reason += std::string("; no picture of it is kept: ") + error.what();
    failure = std::current_exception();
  }
  journal_.record_attempt(row);
  if (failure) std::rethrow_exception(failure);
}

reconstruct::PublishLayer SampleRecords::prepare_layer(const JudgedFrame& frame) const {
  try {
    return surroundings_.prepare_layer(
        sample_.layer_path(frame.layer), frame.frame.image,
        {.layer = frame.layer, .spacing = sample_.description().cuboid.spacing},
        store_.layer_format);
  } catch (...) {
    return [error = std::current_exception()]() -> reconstruct::StoredLayer {
      std::rethrow_exception(error);
    };
  }
}

std::uint64_t SampleRecords::commit_layer(JudgedFrame& frame) {
  const reconstruct::PublishLayer prepared = std::exchange(frame.prepared, nullptr);
  AttemptRow row = row_of(frame);
  const std::filesystem::path path = sample_.layer_path(frame.layer);
  reconstruct::StoredLayer stored;
  try {
    stored = prepared ? prepared() : prepare_layer(frame)();
  } catch (const std::exception& error) {
    row.assessment.verdict = Verdict::not_stored;
    row.assessment.slug = "not-stored";
    row.assessment.reason = error.what();
    journal_.record_attempt(row);
    frame.is_recorded = true;
    throw;
  }
  row.file = std::filesystem::relative(path, sample_.path()).string();
  row.sha256 = stored.sha256;
  journal_.commit_layer(row, stored.bytes, now());
  return stored.bytes;
}

std::int64_t SampleRecords::disk_left_layers() const {
  return static_cast<std::int64_t>(surroundings_.free_bytes(sample_.path()) / bytes_per_layer_);
}

std::string SampleRecords::now() const {
  return utc_text(surroundings_.wall_clock());
}

AttemptRow SampleRecords::row_of(const JudgedFrame& frame) const {
  return {.layer = frame.layer,
          .attempt = frame.attempt,
          .taken_at = frame.taken_at,
          .frame_sequence = frame.frame.sequence,
          .exposure_us = frame.frame.exposure.count(),
          .gain = frame.frame.gain,
          .column = frame.column,
          .assessment = frame.assessment,
          .file = "",
          .sha256 = "",
          .telemetry = frame.telemetry};
}

}  // namespace biotomy::acquisition
