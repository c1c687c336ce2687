#include "acquisition/job/assessed_frame.hpp"

#include <future>

namespace biotomy::acquisition {

AssessedFrame assess_and_prepare(const SampleRecords& records, const JudgedFrame& frame,
                                 const FrameExpectation& expectation,
                                 const QualityThresholds& thresholds) {
  // A thread and not a task of the pool: it waits for the disk, while a core is left for the rest.
  auto layer = std::async(std::launch::async, [&] { return records.prepare_layer(frame); });
  Assessment assessment = assess(frame.frame, expectation, thresholds);
  return {std::move(assessment), layer.get()};
}

}  // namespace biotomy::acquisition
