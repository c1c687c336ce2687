#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "acquisition/records/journal_reader.hpp"
#include "acquisition/records/journal_rows.hpp"
#include "acquisition/settings/job_plan.hpp"
#include "firmware_bridge/camera/camera.hpp"
#include "reconstruct/sample/sample_folder.hpp"

namespace biotomy::acquisition {

// Whether a sample that is there can be gone on with: nothing when it can, else what is wrong and
// what to do, in one sentence.

/// What the job would begin, with frames of this camera.
reconstruct::SampleDescription description_of(const JobPlan& plan,
                                              const bridge::CameraDescription& camera,
                                              const std::string& created);

/// Another size, depth, spacing or name than the job's.
std::optional<std::string> sample_complaint(const reconstruct::SampleFolder& sample,
                                            const JobPlan& plan,
                                            const bridge::CameraDescription& camera);

/// A committed layer whose file is missing or has another size than was committed.
std::optional<std::string> committed_files_complaint(const reconstruct::SampleFolder& sample,
                                                     const JournalReader& journal);

/// Whether what is the same for all layers was recorded, and layers by it are committed.
bool holds_constants(const JournalSummary& journal);

/// Something that was the same for all layers so far and would be another for the next.
std::optional<std::string> constants_complaint(const JournalSummary& journal,
                                               const std::vector<Constant>& constants);

/// On the disk: the image and its part of the volume, as if neither could be compressed.
std::uint64_t bytes_of_a_layer(const JobPlan& plan, const bridge::CameraDescription& camera);

}  // namespace biotomy::acquisition
