#include <atomic>
#include <csignal>
#include <cstdio>
#include <ctime>
#include <iostream>
#include <stdexcept>
#include <string>

#include <CLI/CLI.hpp>

#include "acquisition/job/control_loop.hpp"
#include "acquisition/job/job.hpp"
#include "acquisition/job/state_diagram.hpp"
#include "acquisition/log.hpp"
#include "acquisition/records/sample_lock.hpp"
#include "acquisition/service/access.hpp"
#include "acquisition/service/api.hpp"
#include "acquisition/service/configuration.hpp"
#include "acquisition/service/configuration_reference.hpp"
#include "acquisition/service/devices.hpp"
#include "acquisition/service/http_server.hpp"

namespace {

using namespace biotomy::acquisition;
using std::chrono::steady_clock;

constexpr int kFailure = 1;
constexpr int kUsage = 2;
constexpr const char* kJournalName = "journal.sqlite";

/// SIGTERM and SIGINT, taken by the main thread alone when it asks. Made before any other thread.
class StopSignals {
 public:
  StopSignals() {
    sigemptyset(&set_);
    sigaddset(&set_, SIGTERM);
    sigaddset(&set_, SIGINT);
    pthread_sigmask(SIG_BLOCK, &set_, nullptr);
    std::signal(SIGPIPE, SIG_IGN);
  }

  /// True when one came within the time.
  bool wait(std::chrono::milliseconds time) const {
    const timespec limit{.tv_sec = time.count() / 1000, .tv_nsec = time.count() % 1000 * 1'000'000};
    return sigtimedwait(&set_, nullptr, &limit) > 0;
  }

 private:
  sigset_t set_{};
};

int run(const Configuration& configuration) {
  const StopSignals signals;
  const JobPlan& plan = configuration.job.plan;
  const SampleLock lock(plan.sample);
  const std::filesystem::path journal = plan.sample / kJournalName;
  const std::string token = read_or_make_token(configuration.service.token_file);
  const auto stage = make_stage(configuration.stage);
  const auto lines = make_lines(configuration.lines);
  const auto camera = make_camera(configuration.camera);

  ThreadWorker worker;
  ThreadWorker volume_worker;
  OperatorDesk desk;
  StatusBoard board;
  Job job(configuration.job, {*stage, *lines, *camera, worker, volume_worker, desk, board},
          real_surroundings(), read_earlier_run(journal));
  const Api api(board, desk, journal, token);
  const HttpServer server(api, configuration.service.host, configuration.service.port);

  std::atomic<bool> failed{false};
  std::atomic<bool> at_rest{true};
  bool came_to_rest = false;
  {
    const ControlLoop loop(
        configuration.service.tick,
        [&](TimePoint now) {
          job.tick(now);
          at_rest = job.at_rest();
        },
        [&](const char* what) {
          log_error("daemon", std::string("the control loop failed: ") + what);
          failed = true;
        });
    log_info("daemon", "listening on http://" + configuration.service.host + ":" +
                           std::to_string(server.port()));
    while (!failed && !signals.wait(std::chrono::milliseconds(200))) {
    }
    log_info("daemon", "is ending: brings the rig to rest");
    auto reply = desk.post(OperatorCommand::shut_down, "");
    const auto limit = steady_clock::now() + configuration.service.stop_limit;
    while (!failed && steady_clock::now() < limit) {
      const bool heard = reply.wait_for(std::chrono::milliseconds(0)) == std::future_status::ready;
      came_to_rest = heard && at_rest;
      if (came_to_rest) break;
      signals.wait(std::chrono::milliseconds(50));
    }
  }
  if (!came_to_rest) job.halt(steady_clock::now());
  return failed ? kFailure : 0;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"Runs a grinding rig: grinds, photographs and stores, layer by layer."};
  app.set_version_flag("--version", BIOTOMY_VERSION);
  std::string file;
  bool reference = false;
  bool diagram = false;
  auto* config = app.add_option("--config", file, "the configuration, rig.toml");
  app.add_flag("--configuration-reference", reference,
               "print every key of the configuration (Markdown) and end")
      ->excludes(config);
  app.add_flag("--state-diagram", diagram, "print the states of a job (Markdown) and end")
      ->excludes(config);
  try {
    app.parse(argc, argv);
    if (reference) {
      std::cout << configuration_reference();
      return 0;
    }
    if (diagram) {
      std::cout << state_diagram();
      return 0;
    }
    if (file.empty()) throw CLI::RequiredError("--config");
    log_to_stderr();
    return run(read_configuration(file));
  } catch (const CLI::Success& request) {  // --help, --version
    return app.exit(request);
  } catch (const CLI::ParseError& error) {
    std::cerr << "biotomyd: " << error.what() << '\n';
    return kUsage;
  } catch (const std::invalid_argument& error) {
    std::cerr << "biotomyd: " << error.what() << '\n';
    return kUsage;
  } catch (const std::exception& error) {
    std::cerr << "biotomyd: " << error.what() << '\n';
    return kFailure;
  }
}
