// What the parts of the judgement of a frame cost, with Google Benchmark: to measure its tiles, to
// find repeated rows, to take the print of a face and of its surface, to compare two of either; and
// what the whole of it costs. The frame has 20 megapixels of noisy texture; items are its pixels.
//
//   quality_bench [--benchmark_filter=compare] …

#include <cstdint>
#include <memory>
#include <vector>

#include <benchmark/benchmark.h>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "acquisition/calibration/field_correction.hpp"
#include "acquisition/quality/camera_noise.hpp"
#include "acquisition/quality/clipping_levels.hpp"
#include "acquisition/quality/consecutive_frames.hpp"
#include "acquisition/quality/face_change.hpp"
#include "acquisition/quality/face_print.hpp"
#include "acquisition/quality/frame_measures.hpp"
#include "acquisition/quality/frame_rows.hpp"
#include "acquisition/quality/light_judgement.hpp"
#include "acquisition/quality/sharpness_comparison.hpp"
#include "acquisition/quality/surface_defects.hpp"
#include "acquisition/quality/thumbnail.hpp"

namespace {

using namespace biotomy::acquisition;
using biotomy::bridge::Transfer;

constexpr int kWidth = 5472;
constexpr int kHeight = 3648;

/// The same texture for the same depth, other noise for every exposure.
cv::Mat frame(std::uint64_t depth, std::uint64_t exposure, int type) {
  cv::Mat coarse(kHeight / 4, kWidth / 4, CV_32FC3);
  cv::RNG(depth).fill(coarse, cv::RNG::UNIFORM, 60.0, 180.0);
  cv::Mat face;
  cv::resize(coarse, face, {kWidth, kHeight}, 0.0, 0.0, cv::INTER_CUBIC);
  cv::Mat noise(face.size(), face.type());
  cv::RNG(exposure).fill(noise, cv::RNG::NORMAL, 0.0, 2.0);
  face += noise;
  cv::Mat image;
  face.convertTo(image, type, type == CV_16UC3 ? 257.0 : 1.0);
  return image;
}

void count_pixels(benchmark::State& state) {
  state.SetItemsProcessed(state.iterations() * kWidth * kHeight);
}

/// Corrects copies of one frame: of another the tables' memory would be asked in another order.
void correct_field(benchmark::State& state, int type, bool with_dark, Transfer transfer) {
  const cv::Mat seen = frame(1, 2, type);
  cv::Mat image = seen.clone();
  const cv::Mat flat = frame(3, 4, CV_16UC3);
  cv::Mat dark;
  if (with_dark) dark = cv::Mat(flat.size(), CV_16UC3, cv::Scalar::all(300));
  const FieldCorrection correction(flat, dark, type, transfer);
  for (auto _ : state) {
    state.PauseTiming();
    seen.copyTo(image);
    state.ResumeTiming();
    correction.apply(image);
    benchmark::DoNotOptimize(image.data);
  }
  count_pixels(state);
}

void find_rows(benchmark::State& state, int type) {
  const cv::Mat image = frame(1, 2, type);
  for (auto _ : state) {
    benchmark::DoNotOptimize(rows_of(image));
  }
  count_pixels(state);
}

void measure(benchmark::State& state, int type) {
  const cv::Mat image = frame(1, 2, type);
  for (auto _ : state) {
    benchmark::DoNotOptimize(measure_frame(image));
  }
  count_pixels(state);
}

void tell_noise(benchmark::State& state) {
  const FrameMeasures one = measure_frame(frame(1, 2, CV_8UC3));
  const FrameMeasures other = measure_frame(frame(1, 3, CV_8UC3));
  for (auto _ : state) {
    benchmark::DoNotOptimize(noise_between(one, other));
  }
}

/// With its rows.
void take_print(benchmark::State& state, int type) {
  const cv::Mat image = frame(1, 2, type);
  for (auto _ : state) {
    benchmark::DoNotOptimize(take_face_print(image));
  }
  count_pixels(state);
}

void compare(benchmark::State& state, std::uint64_t depth) {
  const FacePrint before = take_face_print(frame(1, 2, CV_8UC3));
  const FacePrint now = take_face_print(frame(depth, 3, CV_8UC3));
  for (auto _ : state) {
    benchmark::DoNotOptimize(measure_face_change(now, before));
  }
  count_pixels(state);
}

void thumbnail(benchmark::State& state, int type) {
  const cv::Mat image = frame(1, 2, type);
  for (auto _ : state) {
    benchmark::DoNotOptimize(take_thumbnail(image));
  }
  count_pixels(state);
}

/// With its thumbnail.
void surface_print(benchmark::State& state, int type) {
  const cv::Mat image = frame(1, 2, type);
  for (auto _ : state) {
    benchmark::DoNotOptimize(take_surface_print(image));
  }
  count_pixels(state);
}

/// Frames of eight layers before, and one to be compared with them.
struct Surfaces {
  cv::Mat image;
  SurfacePrint now;
  SurfaceRecord record;

  explicit Surfaces(std::uint64_t depth) : image(frame(depth, 3, CV_8UC3)) {
    now = take_surface_print(image);
    const auto before =
        std::make_shared<const SurfacePrint>(take_surface_print(frame(1, 2, CV_8UC3)));
    for (std::size_t i = 0; i < SurfaceRecord::kRemembered; ++i) {
      record.accept(1, before, FrameLight{.casting = learn_casting(before->light)});
    }
  }
};

void light(benchmark::State& state, std::uint64_t depth) {
  const Surfaces surfaces(depth);
  for (auto _ : state) {
    benchmark::DoNotOptimize(find_light(surfaces.now, surfaces.record));
  }
  count_pixels(state);
}

void shift(benchmark::State& state, std::uint64_t depth) {
  const Surfaces surfaces(depth);
  for (auto _ : state) {
    benchmark::DoNotOptimize(measure_shift(surfaces.now.border, surfaces.record.surface()->border));
  }
  count_pixels(state);
}

void surface_defects(benchmark::State& state, std::uint64_t depth) {
  const Surfaces surfaces(depth);
  const ClippingLevels levels = clipping_levels(surfaces.image);
  for (auto _ : state) {
    benchmark::DoNotOptimize(
        find_surface_defects(surfaces.image, levels, surfaces.now, surfaces.record, {}));
  }
  count_pixels(state);
}

/// How sharp a frame is against three.
void sharpness_of(benchmark::State& state) {
  const auto now = measure_frame(frame(9, 3, CV_8UC3));
  const auto before = std::make_shared<const FrameMeasures>(measure_frame(frame(1, 2, CV_8UC3)));
  const std::vector<std::shared_ptr<const FrameMeasures>> references(3, before);
  for (auto _ : state) {
    benchmark::DoNotOptimize(compare_sharpness(now, references, 0.96));
  }
  count_pixels(state);
}

enum class Content { texture, bare, specks };

cv::Mat content(Content content, std::uint64_t depth, std::uint64_t exposure, int type) {
  cv::Mat image = frame(depth, exposure, type);
  if (content == Content::texture) return image;
  const double full = type == CV_16UC3 ? 65535.0 : 255.0;
  cv::Mat noise = image - frame(depth, exposure + 100, type);
  image = 0.2 * noise + cv::Scalar(0.25, 0.5, 0.35) * full;
  cv::RNG random(depth);
  for (int i = 0; content == Content::specks && i < 5000; ++i) {
    cv::circle(image, {random.uniform(0, kWidth), random.uniform(0, kHeight)}, 12,
               cv::Scalar(random.uniform(0.0, full), random.uniform(0.0, full), 0.0), cv::FILLED);
  }
  return image;
}

/// All of the judgement of a frame, after three layers.
void assess_frame(benchmark::State& state, Content what, int type) {
  ConsecutiveFrames layers{QualityThresholds{}};
  for (std::uint64_t depth = 1; depth <= 3; ++depth) {
    layers.accept(layers.judge(content(what, depth, depth, type), static_cast<std::int64_t>(depth)),
                  false);
  }
  const cv::Mat image = content(what, 4, 4, type);
  for (auto _ : state) {
    ConsecutiveFrames again = layers;
    benchmark::DoNotOptimize(again.judge(image, 4));
  }
  count_pixels(state);
}

}  // namespace

int main(int argc, char** argv) {
  benchmark::RegisterBenchmark("correct/8/flat/linear", correct_field, CV_8UC3, false,
                               Transfer::linear)
      ->UseRealTime();
  benchmark::RegisterBenchmark("correct/8/both/linear", correct_field, CV_8UC3, true,
                               Transfer::linear)
      ->UseRealTime();
  benchmark::RegisterBenchmark("correct/16/both/linear", correct_field, CV_16UC3, true,
                               Transfer::linear)
      ->UseRealTime();
  benchmark::RegisterBenchmark("correct/8/flat/srgb", correct_field, CV_8UC3, false, Transfer::srgb)
      ->UseRealTime();
  benchmark::RegisterBenchmark("correct/8/both/srgb", correct_field, CV_8UC3, true, Transfer::srgb)
      ->UseRealTime();
  benchmark::RegisterBenchmark("correct/16/both/srgb", correct_field, CV_16UC3, true,
                               Transfer::srgb)
      ->UseRealTime();
  benchmark::RegisterBenchmark("rows/8", find_rows, CV_8UC3)->UseRealTime();
  benchmark::RegisterBenchmark("rows/16", find_rows, CV_16UC3)->UseRealTime();
  benchmark::RegisterBenchmark("measures/8", measure, CV_8UC3)->UseRealTime();
  benchmark::RegisterBenchmark("measures/16", measure, CV_16UC3)->UseRealTime();
  benchmark::RegisterBenchmark("noise", tell_noise)->UseRealTime();
  benchmark::RegisterBenchmark("print/8", take_print, CV_8UC3)->UseRealTime();
  benchmark::RegisterBenchmark("print/16", take_print, CV_16UC3)->UseRealTime();
  benchmark::RegisterBenchmark("compare/same", compare, 1)->UseRealTime();
  benchmark::RegisterBenchmark("compare/other", compare, 9)->UseRealTime();
  benchmark::RegisterBenchmark("thumbnail/8", thumbnail, CV_8UC3)->UseRealTime();
  benchmark::RegisterBenchmark("thumbnail/16", thumbnail, CV_16UC3)->UseRealTime();
  benchmark::RegisterBenchmark("surface_print/8", surface_print, CV_8UC3)->UseRealTime();
  benchmark::RegisterBenchmark("surface_print/16", surface_print, CV_16UC3)->UseRealTime();
  benchmark::RegisterBenchmark("light/same", light, 1)->UseRealTime();
  benchmark::RegisterBenchmark("light/other", light, 9)->UseRealTime();
  benchmark::RegisterBenchmark("shift/same", shift, 1)->UseRealTime();
  benchmark::RegisterBenchmark("shift/other", shift, 9)->UseRealTime();
  benchmark::RegisterBenchmark("surface_defects/same", surface_defects, 1)->UseRealTime();
  benchmark::RegisterBenchmark("surface_defects/other", surface_defects, 9)->UseRealTime();
  benchmark::RegisterBenchmark("sharpness", sharpness_of)->UseRealTime();
  benchmark::RegisterBenchmark("assess/8/texture", assess_frame, Content::texture, CV_8UC3)
      ->UseRealTime();
  benchmark::RegisterBenchmark("assess/8/bare", assess_frame, Content::bare, CV_8UC3)
      ->UseRealTime();
  benchmark::RegisterBenchmark("assess/8/specks", assess_frame, Content::specks, CV_8UC3)
      ->UseRealTime();
  benchmark::RegisterBenchmark("assess/16/texture", assess_frame, Content::texture, CV_16UC3)
      ->UseRealTime();
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) {
    return 2;
  }
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
  return 0;
}
