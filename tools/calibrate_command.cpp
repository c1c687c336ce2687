#include <chrono>
#include <iostream>
#include <memory>
#include <stdexcept>
#include <string>
#include <thread>

#include <nlohmann/json.hpp>
#include <unistd.h>

#include "tools/command.hpp"
#include "tools/daemon_connection.hpp"
#include "tools/patient_look.hpp"

namespace biotomy::tools {
namespace {

constexpr std::chrono::milliseconds kLook{100};

struct Options {
  DaemonOptions daemon;
  std::string reason;
};

/// Asks for a calibration and waits for its end: what was found is printed, what hindered it
/// thrown.
void calibrate(const Options& options, const std::string& kind) {
  DaemonConnection daemon(options.daemon);
  daemon.command("calibrate-" + kind, options.reason);
  const bool terminal = ::isatty(STDERR_FILENO) == 1;
  PatientLook look(daemon, {});
  while (true) {
    const nlohmann::json calibration = look.status().value("calibration", nlohmann::json());
    if (!calibration.is_object() || calibration.value("kind", "") != kind) {
      throw std::runtime_error(
          "the daemon knows nothing of the calibration any more: was it "
          "started anew, or does somebody else calibrate?");
    }
    const std::string progress = calibration.value("progress", "");
    const std::string sentence = calibration.value("sentence", "");
    if (terminal) std::cerr << "\r\033[K";
    if (progress == "done") {
      std::cout << sentence << '\n';
      return;
    }
    if (progress == "failed") throw std::runtime_error(sentence);
    if (terminal) std::cerr << sentence << std::flush;
    // The daemon limits each step of a calibration, and a daemon that is gone ends this by itself.
    std::this_thread::sleep_for(kLook);
  }
}

}  // namespace

void add_calibrate_command(CLI::App& app) {
  auto options = std::make_shared<Options>();
  CLI::App* calibrate_command = app.add_subcommand(
      "calibrate", "Records a calibration of a rig at rest, through its daemon.");
  calibrate_command->require_subcommand(1);
  for (const auto& [kind, description] :
       {std::pair{"flat", "With the lamp on, of an even, pale surface: how the light is spread"},
        std::pair{"dark", "With the lamp off: what the sensor shows without light"},
        std::pair{"white", "With the lamp on, of a grey card: the gains that make it neutral"},
        std::pair{
            "focus",
            "Of the block's face: homes the axes if need be, moves the column or the lens and "
            "finds where the face is sharp, for focus.start_um"}}) {
    CLI::App* command = calibrate_command->add_subcommand(kind, description);
    add_daemon_options(*command, options->daemon);
    command->add_option("--reason", options->reason, "A few words for the journal");
    command->callback([options, kind = std::string(kind)] { calibrate(*options, kind); });
  }
}

}  // namespace biotomy::tools
