// How long the page waits for the section of a plane that somebody drags, within one program and
// without a network: JPEGs that fit a window, of a plane that is turned and moved a little each
// time. Prints one line of JSON.
//
//   page_previews SAMPLE [--fit 1024x768] [--steps 60] [--threads 1]

#include <algorithm>
#include <chrono>
#include <cmath>
#include <iostream>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "acquisition/viewer/sample_api.hpp"
#include "tests/bench/exit_code.hpp"

namespace {

using namespace biotomy::acquisition;

struct Options {
  std::string sample;
  std::string fit = "1024x768";
  int steps = 60;
  int threads = 1;
};

/// Through the block's middle, leaning more with each step, and moved to and fro.
std::map<std::string, std::string> plane(const nlohmann::json& sample, int step,
                                         const std::string& fit) {
  std::ostringstream normal;
  std::ostringstream through;
  const double angle = 0.6 + 0.01 * step;
  normal << std::cos(angle) * 0.8 << ',' << std::cos(angle) * 0.6 << ',' << std::sin(angle);
  const auto middle = [&](std::size_t axis) {
    return 0.5 * sample.at("size").at(axis).get<double>() *
           sample.at("spacing_um").at(axis).get<double>();
  };
  through << middle(0) << ',' << middle(1) << ',' << middle(2) * (1.0 + 0.2 * std::sin(0.1 * step));
  return {{"normal", normal.str()}, {"through", through.str()}, {"format", "jpeg"}, {"fit", fit}};
}

void run(const Options& options) {
  const SampleApi api(options.sample, {.threads = options.threads});
  const auto ask = [&](const std::string& path, std::map<std::string, std::string> query) {
    ApiResponse response =
        api.answer({.method = "GET", .path = "/api/v1/" + path, .query = std::move(query)});
    if (response.status != 200) throw std::runtime_error(response.body);
    return response;
  };
  const auto sample = nlohmann::json::parse(ask("sample", {}).body);
  std::vector<double> seconds;
  std::size_t bytes = 0;
  for (int step = 0; step < options.steps; ++step) {
    const auto begin = std::chrono::steady_clock::now();
    bytes += ask("section", plane(sample, step, options.fit)).body.size();
    seconds.push_back(
        std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count());
  }
  const double first = seconds.front();
  std::sort(seconds.begin(), seconds.end());
  std::cout << nlohmann::ordered_json{{"first_s", first},
                                      {"median_s", seconds[seconds.size() / 2]},
                                      {"ninth_tenth_s", seconds[seconds.size() * 9 / 10]},
                                      {"most_s", seconds.back()},
                                      {"bytes", bytes / seconds.size()}}
                   .dump()
            << '\n';
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"Times the sections of a plane that is dragged"};
  Options options;
  app.add_option("SAMPLE", options.sample, "The sample's folder")->required();
  app.add_option("--fit", options.fit, "Of the picture, pixels")->capture_default_str();
  app.add_option("--steps", options.steps, "How often the plane is moved")
      ->check(CLI::Range(2, 10000))
      ->capture_default_str();
  app.add_option("--threads", options.threads, "That sample a section")
      ->check(CLI::Range(0, 64))
      ->capture_default_str();
  CLI11_PARSE(app, argc, argv);
  return biotomy::bench::exit_code_of("page_previews", [&] { run(options); });
}
