#pragma once

#include "acquisition/quality/assessment.hpp"
#include "acquisition/records/sample_records.hpp"

namespace biotomy::acquisition {

/// What became of a frame: the verdict, and its layer, ready for whoever accepts it. Letting go of
/// the layer gives it up.
struct AssessedFrame {
  Assessment assessment;
  reconstruct::PublishLayer layer;
};

/// Judges a frame, and meanwhile prepares its layer as if it were accepted already: most are, and
/// the next grind waits for both. To be called by the records' owner.
AssessedFrame assess_and_prepare(const SampleRecords& records, const JudgedFrame& frame,
                                 const FrameExpectation& expectation,
                                 const QualityThresholds& thresholds);

}  // namespace biotomy::acquisition
