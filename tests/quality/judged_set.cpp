#include "tests/quality/judged_set.hpp"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <exception>
#include <future>
#include <mutex>

#include "tests/quality/daemon_memory.hpp"

namespace biotomy::tests {
namespace {

using acquisition::Assessment;

struct TimedAssessment {
  Assessment assessment;
  double seconds = 0.0;
};

TimedAssessment timed(const bridge::Frame& frame, const DaemonMemory& memory) {
  const auto begin = std::chrono::steady_clock::now();
  Assessment assessment = acquisition::assess(frame, memory.expectation(), {});
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begin;
  return {std::move(assessment), took.count()};
}

JudgedFrame judged(const LabelledFrame& labelled, const TimedAssessment& found, int sequence,
                   int layer) {
  return {.sequence = sequence,
          .layer = layer,
          .defect = labelled.defect,
          .strength = labelled.strength,
          .contrast = labelled.contrast,
          .demand = labelled.demand,
          .rejected = found.assessment.verdict == acquisition::Verdict::rejected,
          .slug = found.assessment.slug,
          .reason = found.assessment.reason,
          .metrics = found.assessment.metrics,
          .seconds = found.seconds};
}

std::vector<JudgedFrame> judge_sequence(const SequenceSettings& settings, int number) {
  std::vector<JudgedFrame> frames;
  PhantomSequence sequence(settings);
  DaemonMemory memory;
  while (const std::optional<LabelledLayer> layer = sequence.next()) {
    memory.begin(layer->layer, layer->good.frame);
    if (layer->bracket) memory.focused(*layer->bracket);
    for (const LabelledFrame& defective : layer->defective) {
      frames.push_back(judged(defective, timed(defective.frame, memory), number, layer->layer));
    }
    const TimedAssessment good = timed(layer->good.frame, memory);
    frames.push_back(judged(layer->good, good, number, layer->layer));
    memory.accepted(layer->good.frame, good.assessment);
  }
  return frames;
}

}  // namespace

const acquisition::Metric* JudgedFrame::metric(std::string_view name) const {
  const auto found = std::ranges::find(metrics, name, &acquisition::Metric::name);
  return found == metrics.end() ? nullptr : &*found;
}

std::vector<JudgedFrame> judge_set(const std::vector<SequenceSettings>& set, int threads,
                                   const std::function<void()>& sequence_done) {
  std::vector<std::vector<JudgedFrame>> sequences(set.size());
  std::atomic<std::size_t> next{0};
  std::mutex telling;
  const auto work = [&] {
    for (std::size_t i = next++; i < set.size(); i = next++) {
      sequences[i] = judge_sequence(set[i], static_cast<int>(i));
      const std::lock_guard lock(telling);
      sequence_done();
    }
  };
  std::vector<std::future<void>> workers;
  workers.reserve(static_cast<std::size_t>(threads));
  for (int i = 0; i < threads; ++i) workers.push_back(std::async(std::launch::async, work));
  for (std::future<void>& worker : workers) worker.get();

  std::vector<JudgedFrame> all;
  for (std::vector<JudgedFrame>& frames : sequences) {
    std::ranges::move(frames, std::back_inserter(all));
  }
  return all;
}

}  // namespace biotomy::tests
