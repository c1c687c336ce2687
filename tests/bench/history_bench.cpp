// How long the history of metrics takes that the page's charts begin with: of a made-up journal in
// a temporary folder, with as many metrics an attempt as the daemon writes. Prints one line of
// JSON.
//
//   history_bench [--layers 10000] [--metrics 30] [--times 10]

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <iostream>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <SQLiteCpp/SQLiteCpp.h>
#include <nlohmann/json.hpp>

#include "acquisition/quality/metrics_json.hpp"
#include "acquisition/records/layer_journal.hpp"
#include "acquisition/viewer/sample_api.hpp"
#include "reconstruct/sample/sample_folder.hpp"
#include "tests/bench/exit_code.hpp"
#include "tests/temporary_folder.hpp"

namespace {

using namespace biotomy::acquisition;

struct Options {
  std::int64_t layers = 10'000;
  int metrics = 30;
  int times = 10;
};

std::string metrics_of(std::int64_t layer, int count) {
  std::vector<Metric> metrics;
  for (int i = 0; i < count; ++i) {
    metrics.push_back({"metric_of_a_long_name_" + std::to_string(i),
                       0.123456789 + static_cast<double>(layer % 97) / 97.0 + i, 0.7, true});
  }
  return metrics_json(metrics).dump();
}

/// One attempt a layer, and a rejected one before at every tenth.
void fill(const std::filesystem::path& journal, const Options& options) {
  { const LayerJournal made(journal); }
  SQLite::Database database(journal.string(), SQLite::OPEN_READWRITE);
  SQLite::Transaction transaction(database);
  SQLite::Statement insert(
      database,
      "INSERT INTO attempts (layer, attempt, taken_at, frame_sequence, exposure_us, gain, "
      "column_um, verdict, slug, reason, metrics, file, sha256, telemetry) VALUES (?, ?, "
      "'2026-11-22T03:04:05.678Z', 1, 4000, 1.0, ?, ?, 'good', 'every metric is within its limit', "
      "?, '', '', ?)");
  const std::string telemetry(600, 't');
  for (std::int64_t layer = 1; layer <= options.layers; ++layer) {
    const int attempts = layer % 10 == 0 ? 2 : 1;
    for (int attempt = 1; attempt <= attempts; ++attempt) {
      insert.reset();
      insert.bind(1, layer);
      insert.bind(2, attempt);
      insert.bind(3, 600.0 + static_cast<double>(layer) * 0.02);
      insert.bind(4, attempt == attempts ? "accepted" : "rejected");
      insert.bind(5, metrics_of(layer, options.metrics));
      insert.bind(6, telemetry);
      insert.exec();
    }
  }
  transaction.commit();
}

void run(const Options& options) {
  const biotomy::tests::TemporaryFolder folder;
  biotomy::reconstruct::SampleDescription description;
  description.name = "made up";
  description.created = "2026-11-22T03:04:05Z";
  description.cuboid = {{100, 100, options.layers}, {10.0, 10.0, 20.0}};
  const auto sample = biotomy::reconstruct::SampleFolder::create(folder / "sample", description);
  fill(sample.journal_path(), options);

  const SampleApi api(sample.path(), {});
  const std::string metrics =
      "metric_of_a_long_name_0,metric_of_a_long_name_7,metric_of_a_long_name_15,metric_of_a_long_"
      "name_29";
  std::vector<double> seconds;
  std::size_t bytes = 0;
  for (int i = 0; i < options.times; ++i) {
    const auto begin = std::chrono::steady_clock::now();
    const ApiResponse response =
        api.answer({.method = "GET", .path = "/api/v1/history", .query = {{"metrics", metrics}}});
    seconds.push_back(
        std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count());
    if (response.status != 200) throw std::runtime_error(response.body);
    bytes = response.body.size();
  }
  const double first = seconds.front();
  std::sort(seconds.begin(), seconds.end());
  std::cout << nlohmann::ordered_json{{"layers", options.layers},
                                      {"answer_bytes", bytes},
                                      {"first_s", first},
                                      {"median_s", seconds[seconds.size() / 2]},
                                      {"most_s", seconds.back()}}
                   .dump()
            << '\n';
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"Times the history of metrics of a made-up journal"};
  Options options;
  app.add_option("--layers", options.layers, "Of the journal")
      ->check(CLI::Range(1, 999999))
      ->capture_default_str();
  app.add_option("--metrics", options.metrics, "Of each attempt")
      ->check(CLI::Range(30, 1000))
      ->capture_default_str();
  app.add_option("--times", options.times, "How often it is asked")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  CLI11_PARSE(app, argc, argv);
  return biotomy::bench::exit_code_of("history_bench", [&] { run(options); });
}
