#include <csignal>
#include <ctime>
#include <exception>
#include <iostream>
#include <optional>
#include <stdexcept>
#include <string>
#include <thread>

#include <CLI/CLI.hpp>

#include "sim/service/configuration.hpp"
#include "sim/service/twin.hpp"

namespace {

using namespace biotomy;

constexpr int kFailure = 1;
constexpr int kUsage = 2;

int fail(int code, const char* what) {
  std::cerr << "biotomy-sim: " << what << '\n';
  return code;
}

sigset_t ending_signals() {
  sigset_t signals;
  sigemptyset(&signals);
  sigaddset(&signals, SIGINT);
  sigaddset(&signals, SIGTERM);
  return signals;
}

/// Turns SIGINT and SIGTERM, blocked everywhere, into a stop.
void await_signal(const std::stop_token& done, const std::stop_source& stop) {
  const sigset_t signals = ending_signals();
  const timespec patience{0, 50'000'000};
  while (!done.stop_requested()) {
    if (sigtimedwait(&signals, nullptr, &patience) > 0) {
      stop.request_stop();
      return;
    }
  }
}

void run(const std::string& file, const std::string& scenario, std::optional<std::uint64_t> seed) {
  sim::Configuration configuration = sim::read_configuration(bridge::CheckedTable::read_file(file));
  if (seed) {
    configuration.rig.seed = *seed;
    configuration.phantom.seed = *seed;
  }
  if (!scenario.empty()) {
    configuration.rig.scenario = sim::read_scenario(bridge::CheckedTable::read_file(scenario));
  }
  const sigset_t signals = ending_signals();
  pthread_sigmask(SIG_BLOCK, &signals, nullptr);
  sim::Twin twin(configuration);
  const std::stop_source stop;
  const std::jthread signal_waiter([&](const std::stop_token& done) { await_signal(done, stop); });
  std::cout << "biotomy-sim: ready, stage on " << twin.stage_address() << ", camera and lines on "
            << twin.rig_address() << std::endl;
  twin.run(stop.get_token());
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"The rig's twin: controller, camera and lines of a grinding rig with a specimen."};
  app.set_version_flag("--version", BIOTOMY_VERSION);
  std::string file;
  std::string scenario;
  std::optional<std::uint64_t> seed;
  app.add_option("--config", file, "The rig to stand in for, a TOML file (sim/README.md)")
      ->required();
  app.add_option("--scenario", scenario, "What breaks in the course, a TOML file (sim/README.md)");
  app.add_option("--seed", seed, "Another specimen, wear and noise than the file's seed");
  try {
    app.parse(argc, argv);
    run(file, scenario, seed);
  } catch (const CLI::Success& request) {  // --help, --version
    return app.exit(request);
  } catch (const CLI::ParseError& error) {
    return fail(kUsage, error.what());
  } catch (const std::invalid_argument& error) {
    return fail(kUsage, error.what());
  } catch (const std::exception& error) {
    return fail(kFailure, error.what());
  }
  return 0;
}
