// What the daemon's assessment makes of the labelled set, with its default thresholds: prints the
// tables of docs/quality.md, or JSON. Ends with 1 when a goal is missed.
//
//   quality_report [--seeds train|test] [--sequences 36] [--width 1600] [--mosaic] [--threads 2]
//                  [--json] [--wrong]

#include <algorithm>
#include <cstdio>
#include <exception>
#include <iostream>
#include <string>
#include <thread>

#include <CLI/CLI.hpp>
#include <opencv2/core/utility.hpp>
#include <unistd.h>

#include "tests/quality/result_tables.hpp"

namespace {

using namespace biotomy::tests;

struct Options {
  std::string seeds = "test";
  int sequences = 36;
  int width = SequenceSettings{}.width;
  int threads = static_cast<int>(std::clamp(std::thread::hardware_concurrency(), 1U, 16U));
  bool mosaic = false;
  bool as_json = false;
  bool wrong = false;
};

int report(const Options& options) {
  // Sequences share the cores, and an assessment's time is that of one core.
  cv::setNumThreads(1);
  auto set = labelled_set(options.seeds == "train" ? Seeds::train : Seeds::test, options.sequences);
  for (SequenceSettings& settings : set) {
    settings.width = options.width;
    settings.height = options.width * 3 / 4;
    settings.mosaic = options.mosaic;
  }
  const bool watched = isatty(STDERR_FILENO) != 0;
  std::size_t done = 0;
  const std::vector<JudgedFrame> frames = judge_set(set, options.threads, [&] {
    ++done;
    if (watched) std::fprintf(stderr, "\r%zu of %zu sequences", done, set.size());
  });
  if (watched) std::fputs("\n", stderr);
  if (options.wrong) std::cerr << wrong_answers(frames);
  const SetResults results = results_of(frames);
  std::cout << (options.as_json ? json(results) + "\n" : markdown(results));
  return results.reached() ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"Report of the assessment on the labelled set"};
  Options options;
  app.add_option("--seeds", options.seeds, "Which set: train or test")
      ->check(CLI::IsMember({"train", "test"}))
      ->capture_default_str();
  app.add_option("--sequences", options.sequences, "Of 30 layers each, about 105 frames")
      ->check(CLI::Range(1, 10000))
      ->capture_default_str();
  app.add_option("--width", options.width, "Of the frames, pixels; they are 4 : 3")
      ->check(CLI::Range(320, 8000))
      ->capture_default_str();
  app.add_option("--threads", options.threads, "Sequences at a time")
      ->check(CLI::Range(1, 64))
      ->capture_default_str();
  app.add_flag("--mosaic", options.mosaic, "Of a camera with one chip: colours are interpolated");
  app.add_flag("--json", options.as_json, "Print JSON in place of tables");
  app.add_flag("--wrong", options.wrong, "List every wrong answer on stderr");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    const int code = app.exit(error);
    return code == 0 ? 0 : 2;
  }
  try {
    return report(options);
  } catch (const std::exception& error) {
    std::cerr << "quality_report: " << error.what() << "\n";
    return 2;
  }
}
