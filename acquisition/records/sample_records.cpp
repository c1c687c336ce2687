#include "acquisition/records/sample_records.hpp"

#include <cmath>
#include <exception>
#include <utility>

#include "acquisition/records/journal_reader.hpp"
#include "acquisition/records/utc_time.hpp"
#include "reconstruct/errors.hpp"
#include "reconstruct/store/temporary_file.hpp"

namespace biotomy::acquisition {
namespace {

using reconstruct::SampleDescription;
using reconstruct::SampleError;
using reconstruct::SampleFolder;

constexpr std::uint64_t kColours = 3;

SampleDescription description_of(const JobPlan& plan, const bridge::CameraDescription& camera,
                                 const std::string& created) {
  return {
      .name = plan.name,
      .cuboid = {.size = {camera.width, camera.height, plan.layers},
                 .spacing = {plan.pixel_x.value, plan.pixel_y.value, plan.layer_thickness.value}},
      .bits = plan.bits,
      .notes = plan.notes,
      .created = created};
}

std::string size_text(const SampleDescription& description) {
  const reconstruct::GridSize& size = description.cuboid.size;
  return std::to_string(size.x) + " × " + std::to_string(size.y) + " × " + std::to_string(size.z) +
         " voxels of " + std::to_string(description.bits) + " bits";
}

bool same_spacing(const reconstruct::Vector3& a, const reconstruct::Vector3& b) {
  constexpr double kTolerance = 1e-6;
  return std::abs(a.x - b.x) < kTolerance && std::abs(a.y - b.y) < kTolerance &&
         std::abs(a.z - b.z) < kTolerance;
}

SampleFolder open_or_create(const JobPlan& plan, const SampleDescription& wanted) {
  if (SampleFolder::can_begin(plan.sample)) return SampleFolder::create(plan.sample, wanted);

  SampleFolder sample = SampleFolder::open(plan.sample);
  const SampleDescription& found = sample.description();
  if (found.cuboid.size != wanted.cuboid.size || found.bits != wanted.bits) {
    throw SampleError("the sample " + plan.sample.string() + " is " + size_text(found) +
                      " and the job would make " + size_text(wanted) +
                      ": name another sample or mend the configuration");
  }
  if (!same_spacing(found.cuboid.spacing, wanted.cuboid.spacing)) {
    throw SampleError("the sample " + plan.sample.string() +
                      " has another spacing than pixel_um and layer_thickness_um say: name another "
                      "sample or mend the configuration");
  }
  if (found.name != wanted.name) {
    throw SampleError("the sample " + plan.sample.string() + " is named \"" + found.name +
                      "\" and the job \"" + wanted.name +
                      "\": name another sample or mend the configuration");
  }
  return sample;
}

}  // namespace

SampleRecords::SampleRecords(const JobPlan& plan, const StorePlan& store,
                             const bridge::CameraDescription& camera, Surroundings surroundings)
    : sample_(
          open_or_create(plan, description_of(plan, camera, utc_text(surroundings.wall_clock())))),
      store_(store),
      surroundings_(std::move(surroundings)),
      journal_(sample_.journal_path()),
      rejected_(sample_.rejected_path(), store.rejected_frames, store.rejected_width_px),
      // The image and its part of the volume, as if neither could be compressed.
      bytes_per_layer_(2 * static_cast<std::uint64_t>(camera.width) *
                       static_cast<std::uint64_t>(camera.height) * kColours *
                       static_cast<std::uint64_t>(plan.bits / 8)) {
  check_committed_files();
  // The lock on the sample keeps others out: what is unfinished there is of a daemon that was
  // killed.
  reconstruct::remove_unfinished_writes(sample_.layer_path(1).parent_path());
  reconstruct::remove_unfinished_writes(sample_.rejected_path());
}

void SampleRecords::check_committed_files() const {
  const JournalReader reader(sample_.journal_path());
  for (const LayerRow& layer : reader.committed_layers(1, sample_.description().cuboid.size.z)) {
    const std::filesystem::path file = sample_.path() / layer.file;
    std::error_code error;
    const std::uintmax_t bytes = std::filesystem::file_size(file, error);
    if (error) {
      throw SampleError("layer " + std::to_string(layer.layer) +
                        " is committed in the journal but its file " + file.string() +
                        " is missing: find it before going on");
    }
    if (bytes != layer.bytes) {
      throw SampleError(file.string() + " has " + std::to_string(bytes) +
                        " bytes and the journal committed " + std::to_string(layer.bytes) +
                        ": it was changed since");
    }
  }
}

void SampleRecords::hold_constant(const std::vector<Constant>& constants) {
  const JournalSummary known = journal_.summary();
  if (known.last_committed == 0 || known.constants.empty()) {
    journal_.record_constants(constants);
    return;
  }
  for (const Constant& now : constants) {
    for (const Constant& then : known.constants) {
      if (then.name != now.name || then.value == now.value) continue;
      throw SampleError("layers 1 to " + std::to_string(known.last_committed) +
                        " were photographed with " + then.name + " = " + then.value +
                        ", and the next would be with " + now.value +
                        ": restore it, or name another sample");
    }
  }
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

void SampleRecords::record_rejected(const JudgedFrame& frame) {
  AttemptRow row = row_of(frame);
  if (!frame.frame.image.empty()) {
    const std::filesystem::path file =
        rejected_.add(frame.layer, frame.attempt, frame.assessment.slug, frame.frame.image);
    row.file = std::filesystem::relative(file, sample_.path()).string();
  }
  journal_.record_attempt(row);
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
