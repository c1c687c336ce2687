// What many viewers cost a daemon: asks a running one for the durations of its control loop's ticks
// (/metrics), for a while without viewers and for a while with them. Some of the viewers take the
// stream of events, as an open page does; others ask for it and never read. Prints one line of
// JSON.
//
//   viewers_bench URL [--viewers 50] [--deaf 10] [--seconds 20]

#include <atomic>
#include <chrono>
#include <iostream>
#include <sstream>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include <CLI/CLI.hpp>
#include <httplib.h>
#include <nlohmann/json.hpp>

#include "tests/acquisition/http/raw_client.hpp"
#include "tests/bench/exit_code.hpp"

namespace {

using biotomy::tests::RawClient;
using nlohmann::ordered_json;

constexpr int kDeafBuffer = 4096;
constexpr double kMilliseconds = 1000.0;

struct Options {
  std::string url;
  int viewers = 50;
  int deaf = 10;
  int seconds = 20;
};

/// Of a histogram of /metrics: how many there were, and how long they took together.
struct Total {
  double count = 0.0;
  double seconds = 0.0;
};

double value_of(const std::string& metrics, const std::string& name) {
  std::istringstream lines(metrics);
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with(name + " ")) return std::stod(line.substr(name.size() + 1));
  }
  throw std::runtime_error("the daemon has no metric " + name);
}

std::string metrics_of(const std::string& url) {
  const auto response = httplib::Client(url).Get("/metrics");
  if (!response || response->status != 200) throw std::runtime_error(url + " gives no metrics");
  return response->body;
}

Total total(const std::string& metrics, const std::string& name) {
  return {value_of(metrics, name + "_count"), value_of(metrics, name + "_sum")};
}

ordered_json between(const std::string& before, const std::string& after) {
  ordered_json found;
  for (const auto& [title, name] : {std::pair{"tick_ms", "biotomy_tick_duration_seconds"},
                                    std::pair{"late_ms", "biotomy_tick_lateness_seconds"}}) {
    const Total a = total(before, name);
    const Total b = total(after, name);
    found[title] = kMilliseconds * (b.seconds - a.seconds) / (b.count - a.count);
  }
  return found;
}

ordered_json measured(const Options& options) {
  const std::string before = metrics_of(options.url);
  std::this_thread::sleep_for(std::chrono::seconds(options.seconds));
  return between(before, metrics_of(options.url));
}

void run(const Options& options) {
  const int port = std::stoi(options.url.substr(options.url.rfind(':') + 1));
  ordered_json report;
  report["without"] = measured(options);

  std::atomic<bool> over = false;
  std::atomic<std::uint64_t> bytes = 0;
  std::atomic<int> lost = 0;
  std::vector<std::jthread> viewers;
  for (int i = 0; i < options.viewers; ++i) {
    viewers.emplace_back([&] {
      httplib::Client client(options.url);
      client.set_read_timeout(30);
      client.Get("/api/v1/events", [&](const char*, std::size_t size) {
        bytes += size;
        return !over;
      });
      if (!over) ++lost;
    });
  }
  std::vector<RawClient> deaf;
  for (int i = 0; i < options.deaf; ++i) deaf.emplace_back(port, kDeafBuffer).get("/api/v1/events");
  report["with"] = measured(options);
  report["viewers"] = options.viewers;
  report["viewers_lost"] = lost.load();
  report["kilobytes_a_second_each"] =
      static_cast<double>(bytes) / kMilliseconds / options.seconds / options.viewers;
  over = true;
  std::cout << report.dump() << '\n';
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"Measures what viewers cost a running daemon."};
  Options options;
  app.add_option("url", options.url, "the daemon's, http://127.0.0.1:8080")->required();
  app.add_option("--viewers", options.viewers, "that take every event");
  app.add_option("--deaf", options.deaf, "that never read");
  app.add_option("--seconds", options.seconds, "for each of the two measurements");
  CLI11_PARSE(app, argc, argv);
  return biotomy::bench::exit_code_of("viewers_bench", [&] { run(options); });
}
