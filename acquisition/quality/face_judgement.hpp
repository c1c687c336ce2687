#pragma once

#include "acquisition/quality/judgement.hpp"
#include "firmware_bridge/camera/frame.hpp"

namespace biotomy::acquisition {

/// The name of the metric; the journal is asked for it when a job goes on.
inline constexpr const char* kFaceChange = "face_change";

// Whether a frame shows the face in work, whole and as it is now. Each sets `shows_the_face` of the
// result to false when it does not.

/// The camera's own count and clock: a frame that it gave before, or that was exposed before it was
/// asked, is stale. The clock is believed before the count.
void judge_moment(const bridge::Frame& frame, const FrameExpectation& expectation,
                  Judgement& judgement);

/// Rows that were not read out (`dead_rows`) or come from an earlier frame (`repeated_rows`). The
/// result has its face already.
void judge_rows(const FaceRecord& faces, const QualityThresholds& thresholds, Judgement& judgement);

/// Whether the face is another than the last accepted layer's (`face_change`), everywhere
/// (`old_part`). Without a layer before, or without detail to tell by, nothing is judged; for the
/// latter it gives false. The result has its face already.
bool judge_face_change(const FaceRecord& faces, const std::optional<BandNoise>& noise,
                       const QualityThresholds& thresholds, Judgement& judgement);

}  // namespace biotomy::acquisition
