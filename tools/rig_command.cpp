#include <chrono>
#include <cmath>
#include <iomanip>
#include <iostream>
#include <memory>
#include <optional>
#include <sstream>
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

using nlohmann::json;

struct RigOptions {
  DaemonOptions daemon;
  std::string reason;
  bool as_json = false;
  int interval_ms = 500;
  int patience_s = 120;
};

std::string duration_text(double seconds) {
  const long minutes = std::lround(seconds / 60.0);
  if (minutes < 1) return "less than a minute";
  if (minutes < 120) return std::to_string(minutes) + " min";
  return std::to_string(minutes / 60) + " h " + std::to_string(minutes % 60) + " min";
}

std::string number_text(double value) {
  std::ostringstream text;
  text << std::fixed << std::setprecision(1) << value;
  return text.str();
}

void print_row(const std::string& name, const std::string& value) {
  std::cout << std::left << std::setw(12) << name << value << '\n';
}

std::string interlock_text(const json& interlocks) {
  std::string text;
  const auto add = [&text](const json& side, const char* name) {
    if (!side.is_object()) return;
    for (const auto& [key, danger] :
         {std::pair{"estop_pressed", "e-stop pressed"}, std::pair{"door_open", "door open"},
          std::pair{"watchdog_tripped", "watchdog tripped"}}) {
      if (!side.value(key, false)) continue;
      text += (text.empty() ? "" : ", ") + std::string(danger) + " (" + name + ")";
    }
  };
  add(interlocks.at("lines"), "line");
  add(interlocks.at("controller"), "controller");
  return text.empty() ? "good" : text;
}

void print_status(const json& status) {
  std::string state = status.at("state");
  const std::string waiting = status.at("waiting_for");
  if (!waiting.empty()) state += ", " + waiting;
  print_row("state", state);
  const std::string pause_cause = status.value("pause_cause", "");
  if (!pause_cause.empty()) print_row("paused by", pause_cause);
  if (status.at("alarm").is_object()) {
    const json& alarm = status.at("alarm");
    const std::string in_state = alarm.value("state", "faulted");
    print_row("alarm", alarm.at("cause").get<std::string>() + " (since " +
                           alarm.at("since").get<std::string>() +
                           (in_state == "faulted" ? "" : ", while " + in_state) + ")");
  }
  print_row("job",
            status.at("job").get<std::string>() + " in " + status.at("sample").get<std::string>());
  print_row("layers",
            std::to_string(status.at("committed").get<std::int64_t>()) + " of " +
                std::to_string(status.at("layers").get<std::int64_t>()) + " stored, " +
                std::to_string(status.at("volume").at("layers_present").get<std::int64_t>()) +
                " in the volume");
  const std::string failure = status.at("volume").at("failure");
  if (!failure.empty()) print_row("volume", failure);
  if (status.at("seconds_left").is_number()) {
    print_row("time left", duration_text(status.at("seconds_left")));
  }
  if (status.at("disk_left_layers").is_number()) {
    print_row("disk", "room for " +
                          std::to_string(status.at("disk_left_layers").get<std::int64_t>()) +
                          " layers");
  }
  print_row("safety", interlock_text(status.at("interlocks")));
  const json& stage = status.at("stage");
  if (!stage.is_object()) {
    print_row("controller", "has not answered yet");
    return;
  }
  print_row("controller", stage.at("answers").get<bool>()
                              ? stage.at("controller_state").get<std::string>()
                              : std::string("does not answer; what follows is old"));
  const json& positions = stage.at("positions_um");
  print_row("positions", "feed " + number_text(positions.at("feed")) + " µm, column " +
                             number_text(positions.at("column")) + " µm, ground to " +
                             number_text(positions.at("ground_to")) + " µm");
  print_row("block", number_text(stage.at("temperatures_c").at("block")) + " °C");
}

std::string progress_text(const json& status) {
  std::string text = std::to_string(status.at("committed").get<std::int64_t>()) + "/" +
                     std::to_string(status.at("layers").get<std::int64_t>()) + " layers, " +
                     status.at("state").get<std::string>();
  if (status.at("seconds_left").is_number()) {
    text += ", " + duration_text(status.at("seconds_left")) + " left";
  }
  return text;
}

/// States in which steps follow each other; in all others a person is to be told.
bool is_in_a_step(const std::string& state) {
  return state != "idle" && state != "paused" && state != "done" && state != "aborted" &&
         state != "faulted";
}

/// Prints a line for each layer and each change of state that a person should know of, until the
/// job is at its end.
void watch(DaemonConnection& daemon, const RigOptions& options) {
  const bool terminal = ::isatty(STDERR_FILENO) == 1;
  PatientLook look(daemon, {.most = std::chrono::seconds(options.patience_s)});
  std::string shown;
  while (true) {
    const json status = look.status();
    const std::string state = status.at("state");
    const bool in_a_step = is_in_a_step(state) && state != "held";
    std::string line = std::to_string(status.at("committed").get<std::int64_t>()) + "/" +
                       std::to_string(status.at("layers").get<std::int64_t>()) + " layers, " +
                       (in_a_step ? "running" : state);
    const std::string cause = status.at("pause_cause");
    if (!in_a_step && !cause.empty()) line += ": " + cause;
    if (line != shown) {
      if (terminal) std::cerr << "\r\033[K";
      std::cout << line << std::endl;
      shown = line;
    }
    if (state == "done") return;
    if (state == "aborted") throw std::runtime_error("the job was aborted");
    if (state == "faulted") {
      throw std::runtime_error("the rig is stopped: " +
                               status.at("alarm").at("cause").get<std::string>());
    }
    if (terminal) std::cerr << "\r\033[K" << progress_text(status) << std::flush;
    std::this_thread::sleep_for(std::chrono::milliseconds(options.interval_ms));
  }
}

void show_status(DaemonConnection& daemon, const RigOptions& options) {
  if (options.as_json) {
    std::cout << daemon.status_text() << '\n';
  } else {
    print_status(daemon.status());
  }
}

void add_control(CLI::App& rig, const std::string& name, const std::string& description,
                 const std::shared_ptr<RigOptions>& options) {
  CLI::App* command = rig.add_subcommand(name, description);
  add_daemon_options(*command, options->daemon);
  command->add_option("--reason", options->reason, "A few words for the journal");
  command->callback([options, name] {
    std::cout << DaemonConnection(options->daemon).command(name, options->reason) << '\n';
  });
}

}  // namespace

void add_rig_command(CLI::App& app) {
  auto options = std::make_shared<RigOptions>();
  CLI::App* rig = app.add_subcommand("rig", "Asks and commands the daemon of a rig.");
  rig->require_subcommand(1);

  CLI::App* status = rig->add_subcommand("status", "What the rig is doing");
  add_daemon_options(*status, options->daemon);
  status->add_flag("--json", options->as_json, "As the daemon gives it");
  status->callback([options] {
    DaemonConnection daemon(options->daemon);
    show_status(daemon, *options);
  });

  add_control(*rig, "start", "Begins the job, or goes on with its sample", options);
  add_control(*rig, "pause", "Finishes the step at hand and parks the rig", options);
  add_control(*rig, "resume", "Goes on after a pause", options);
  add_control(*rig, "abort", "Stops and parks the rig at once; start goes on with the sample",
              options);
  add_control(*rig, "acknowledge", "Opens the latch after an alarm whose cause is gone", options);

  CLI::App* watch_command =
      rig->add_subcommand("watch",
                          "Follows the job to its end: exit 0 when it is done, 1 when it was "
                          "aborted, or with the alarm when the rig is stopped");
  add_daemon_options(*watch_command, options->daemon);
  watch_command->add_option("--interval", options->interval_ms, "Milliseconds between two looks")
      ->check(CLI::Range(50, 60000))
      ->capture_default_str();
  watch_command
      ->add_option("--patience", options->patience_s,
                   "Seconds for which a daemon that has answered may be away, as when it is "
                   "started anew")
      ->check(CLI::Range(0, 86400))
      ->capture_default_str();
  watch_command->callback([options] {
    DaemonConnection daemon(options->daemon);
    watch(daemon, *options);
  });
}

}  // namespace biotomy::tools
