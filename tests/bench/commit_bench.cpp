// From the last exposure to the permission to grind, with Google Benchmark: a frame of 20
// megapixels of made-up tissue with a camera's noise is assessed, stored durably and committed, by
// the code that the daemon runs. Each repetition is one layer; beside the median stand the longest
// time and the shortest. What parts of it take alone comes before.
//
//   commit_bench [--benchmark_filter=…]          the folder is BIOTOMY_BENCH_FOLDER, or TMPDIR

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <benchmark/benchmark.h>
#include <opencv2/core.hpp>

#include "acquisition/job/assessed_frame.hpp"
#include "acquisition/records/sample_records.hpp"
#include "acquisition/records/surroundings.hpp"
#include "reconstruct/disk/durable_file.hpp"
#include "reconstruct/disk/sha256.hpp"
#include "reconstruct/sample/layer_image.hpp"
#include "tests/bench/made_up_tissue.hpp"

namespace {

using namespace biotomy;
using namespace biotomy::acquisition;
namespace fs = std::filesystem;

constexpr int kWidth = 5472;
constexpr int kHeight = 3648;
constexpr int kRepetitions = 31;

const cv::Mat& photograph() {
  static const cv::Mat image = [] {
    const bench::MadeUpTissue tissue(1.0);
    cv::Mat made(kHeight, kWidth, CV_8UC3);
    for (int y = 0; y < kHeight; ++y) {
      tissue.row(0, y, 0, kWidth, made.ptr<std::uint8_t>(y));
    }
    return made;
  }();
  return image;
}

/// A folder on the disk to be measured; gone when the benchmark ends.
class BenchFolder {
 public:
  BenchFolder() {
    const char* named = std::getenv("BIOTOMY_BENCH_FOLDER");
    std::string path =
        (named != nullptr ? fs::path(named) : fs::temp_directory_path()) / "biotomy-commit-XXXXXX";
    if (mkdtemp(path.data()) == nullptr) throw std::runtime_error("cannot make " + path);
    path_ = path;
  }
  ~BenchFolder() { fs::remove_all(path_); }
  BenchFolder(const BenchFolder&) = delete;
  BenchFolder& operator=(const BenchFolder&) = delete;
  const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

const reconstruct::LayerPosition kPosition{.layer = 1, .spacing = {10.0, 10.0, 20.0}};

std::vector<std::byte> encoded_layer() {
  return reconstruct::encode_layer_image("layer", photograph(), kPosition, {});
}

QualityThresholds lenient() {
  QualityThresholds thresholds;
  thresholds.minimum_sharpness_ratio = 0.0;
  return thresholds;
}

FrameExpectation expectation() {
  FrameExpectation expected;
  expected.width = kWidth;
  expected.height = kHeight;
  expected.type = CV_8UC3;
  return expected;
}

bridge::Frame frame_of(const cv::Mat& image) {
  bridge::Frame frame;
  frame.image = image;
  frame.sequence = 1;
  return frame;
}

/// A sample that is made anew for each benchmark, and its next layer.
class Sample {
 public:
  Sample() {
    JobPlan plan;
    plan.sample = folder_.path() / "sample";
    plan.name = "bench";
    plan.layers = kRepetitions;
    bridge::CameraDescription camera;
    camera.width = kWidth;
    camera.height = kHeight;
    records_ = std::make_unique<SampleRecords>(plan, StorePlan{}, camera, real_surroundings());
  }

  JudgedFrame next_frame() {
    JudgedFrame frame;
    frame.frame = frame_of(photograph());
    frame.layer = ++layer_;
    frame.attempt = 1;
    frame.taken_at = records_->now();
    return frame;
  }

  SampleRecords& records() { return *records_; }

  /// Bounds what the benchmark needs of the disk.
  void forget_layers() const {
    for (const auto& entry : fs::directory_iterator(folder_.path() / "sample" / "layers")) {
      fs::remove(entry.path());
    }
  }

 private:
  BenchFolder folder_;
  std::unique_ptr<SampleRecords> records_;
  std::int64_t layer_ = 0;
};

void assess_alone(benchmark::State& state) {
  const bridge::Frame frame = frame_of(photograph());
  for (auto _ : state) {
    benchmark::DoNotOptimize(assess(frame, expectation(), lenient()));
  }
}

void encode_alone(benchmark::State& state) {
  std::size_t bytes = 0;
  for (auto _ : state) {
    bytes = encoded_layer().size();
  }
  state.counters["ratio"] = static_cast<double>(photograph().total() * photograph().elemSize()) /
                            static_cast<double>(bytes);
}

void hash_alone(benchmark::State& state) {
  const std::vector<std::byte> bytes = encoded_layer();
  for (auto _ : state) {
    benchmark::DoNotOptimize(reconstruct::sha256(bytes));
  }
}

/// What a disk takes to write the file's bytes and nothing else: write, fsync, rename, fsync of the
/// folder.
void write_durably_alone(benchmark::State& state) {
  const std::vector<std::byte> bytes = encoded_layer();
  const BenchFolder folder;
  for (auto _ : state) {
    reconstruct::write_durably(folder.path() / "layer", bytes);
    state.PauseTiming();
    fs::remove(folder.path() / "layer");
    state.ResumeTiming();
  }
}

void write_and_read_back(benchmark::State& state) {
  const std::vector<std::byte> bytes = encoded_layer();
  const BenchFolder folder;
  for (auto _ : state) {
    reconstruct::VerifiedFile(folder.path() / "layer", bytes).publish();
    state.PauseTiming();
    fs::remove(folder.path() / "layer");
    state.ResumeTiming();
  }
}

void one_after_the_other(benchmark::State& state) {
  static Sample sample;
  for (auto _ : state) {
    state.PauseTiming();
    JudgedFrame frame = sample.next_frame();
    state.ResumeTiming();
    frame.assessment = assess(frame.frame, expectation(), lenient());
    sample.records().commit_layer(frame);
    state.PauseTiming();
    sample.forget_layers();
    state.ResumeTiming();
  }
}

void side_by_side(benchmark::State& state) {
  static Sample sample;
  for (auto _ : state) {
    state.PauseTiming();
    JudgedFrame frame = sample.next_frame();
    state.ResumeTiming();
    AssessedFrame assessed = assess_and_prepare(sample.records(), frame, expectation(), lenient());
    frame.assessment = std::move(assessed.assessment);
    frame.prepared = std::move(assessed.layer);
    sample.records().commit_layer(frame);
    state.PauseTiming();
    sample.forget_layers();
    state.ResumeTiming();
  }
}

void layers_one_by_one(benchmark::internal::Benchmark* each) {
  each->Iterations(1)
      ->Repetitions(kRepetitions)
      ->Unit(benchmark::kMillisecond)
      ->UseRealTime()
      ->MeasureProcessCPUTime()
      ->ReportAggregatesOnly()
      ->ComputeStatistics("longest",
                          [](const std::vector<double>& times) {
                            return *std::max_element(times.begin(), times.end());
                          })
      ->ComputeStatistics("shortest", [](const std::vector<double>& times) {
        return *std::min_element(times.begin(), times.end());
      });
}

BENCHMARK(assess_alone)->Apply(layers_one_by_one);
BENCHMARK(encode_alone)->Apply(layers_one_by_one);
BENCHMARK(hash_alone)->Apply(layers_one_by_one);
BENCHMARK(write_durably_alone)->Apply(layers_one_by_one);
BENCHMARK(write_and_read_back)->Apply(layers_one_by_one);
BENCHMARK(one_after_the_other)->Apply(layers_one_by_one);
BENCHMARK(side_by_side)->Apply(layers_one_by_one);

}  // namespace

BENCHMARK_MAIN();
