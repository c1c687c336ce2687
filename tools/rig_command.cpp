#include <chrono>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <iomanip>
#include <iostream>
#include <memory>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <string>
#include <thread>

#include <httplib.h>
#include <nlohmann/json.hpp>
#include <unistd.h>

#include "reconstruct/errors.hpp"
#include "tools/command.hpp"

namespace biotomy::tools {
namespace {

using nlohmann::json;
using reconstruct::InvalidRequest;

constexpr int kConnectSeconds = 3;
constexpr int kAnswerSeconds = 15;
constexpr const char* kTokenVariable = "BIOTOMY_TOKEN";

struct RigOptions {
  std::string url = "http://127.0.0.1:8080";
  std::string token_file;
  std::string reason;
  bool as_json = false;
  int interval_ms = 500;
};

/// The daemon of a rig, over HTTP. What goes wrong is one line that says what to do.
class Daemon {
 public:
  explicit Daemon(const std::string& url) : url_(url), client_(checked(url)) {
    client_.set_connection_timeout(kConnectSeconds);
    client_.set_read_timeout(kAnswerSeconds);
    client_.set_write_timeout(kAnswerSeconds);
  }

  std::string status_text() { return answer(client_.Get("/api/v1/status")); }

  json status() {
    json document = json::parse(status_text(), nullptr, false);
    if (!document.is_object() || !document.contains("state")) {
      throw std::runtime_error(url_ + " answers, but not as biotomyd does: is the URL right?");
    }
    return document;
  }

  std::string command(const std::string& name, const std::string& token,
                      const std::string& reason) {
    const httplib::Headers headers = {{"Authorization", "Bearer " + token}};
    const std::string body = reason.empty() ? "{}" : json{{"reason", reason}}.dump();
    const std::string text =
        answer(client_.Post("/api/v1/control/" + name, headers, body, "application/json"));
    const json document = json::parse(text, nullptr, false);
    return document.is_object() ? document.value("message", "") : "";
  }

 private:
  static const std::string& checked(const std::string& url) {
    if (!url.starts_with("http://")) {
      throw InvalidRequest("--url: \"" + url + "\" is not possible; expected http://host:port");
    }
    return url;
  }

  std::string answer(const httplib::Result& result) const {
    if (!result) {
      throw std::runtime_error("no biotomyd answers at " + url_ +
                               ": is it running, and is --url right?");
    }
    if (result->status == 200) return result->body;
    if (result->status == 401 || result->status == 403) {
      throw std::runtime_error("the daemon at " + url_ +
                               " refused the token: give the file that its service.token_file "
                               "names, with --token-file or BIOTOMY_TOKEN");
    }
    const json document = json::parse(result->body, nullptr, false);
    std::string message = "HTTP status " + std::to_string(result->status);
    if (document.is_object() && document.contains("error") && document["error"].is_object()) {
      message = document["error"].value("message", message);
    }
    throw std::runtime_error(message);
  }

  std::string url_;
  httplib::Client client_;
};

std::string token_of(const RigOptions& options) {
  std::string token;
  if (!options.token_file.empty()) {
    std::ifstream file(options.token_file);
    if (!file || !(file >> token)) {
      throw std::runtime_error("--token-file: no token can be read from " + options.token_file);
    }
    return token;
  }
  if (const char* variable = std::getenv(kTokenVariable)) token = variable;
  if (token.empty()) {
    throw InvalidRequest(
        "a command needs the rig's token: give --token-file, or set BIOTOMY_TOKEN");
  }
  return token;
}

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
  if (status.at("alarm").is_object()) {
    print_row("alarm", status.at("alarm").at("cause").get<std::string>() + " (since " +
                           status.at("alarm").at("since").get<std::string>() + ")");
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
void watch(Daemon& daemon, const RigOptions& options) {
  const bool terminal = ::isatty(STDERR_FILENO) == 1;
  std::string shown;
  while (true) {
    const json status = daemon.status();
    const std::string state = status.at("state");
    const bool in_a_step = is_in_a_step(state);
    const std::string line = std::to_string(status.at("committed").get<std::int64_t>()) + "/" +
                             std::to_string(status.at("layers").get<std::int64_t>()) + " layers, " +
                             (in_a_step ? "running" : state);
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

void show_status(Daemon& daemon, const RigOptions& options) {
  if (options.as_json) {
    std::cout << daemon.status_text() << '\n';
  } else {
    print_status(daemon.status());
  }
}

void add_connection_options(CLI::App& command, const std::shared_ptr<RigOptions>& options) {
  command.add_option("--url", options->url, "where biotomyd listens")->capture_default_str();
}

void add_control(CLI::App& rig, const std::string& name, const std::string& description,
                 const std::shared_ptr<RigOptions>& options) {
  CLI::App* command = rig.add_subcommand(name, description);
  add_connection_options(*command, options);
  command->add_option("--token-file", options->token_file,
                      "the daemon's token file; else BIOTOMY_TOKEN holds the token");
  command->add_option("--reason", options->reason, "a few words for the journal");
  command->callback([options, name] {
    Daemon daemon(options->url);
    std::cout << daemon.command(name, token_of(*options), options->reason) << '\n';
  });
}

}  // namespace

void add_rig_command(CLI::App& app) {
  auto options = std::make_shared<RigOptions>();
  CLI::App* rig = app.add_subcommand("rig", "asks and commands the daemon of a rig");
  rig->require_subcommand(1);

  CLI::App* status = rig->add_subcommand("status", "what the rig is doing");
  add_connection_options(*status, options);
  status->add_flag("--json", options->as_json, "as the daemon gives it");
  status->callback([options] {
    Daemon daemon(options->url);
    show_status(daemon, *options);
  });

  add_control(*rig, "start", "begins the job, or goes on with its sample", options);
  add_control(*rig, "pause", "finishes the step at hand and parks the rig", options);
  add_control(*rig, "resume", "goes on after a pause", options);
  add_control(*rig, "abort", "stops and parks the rig; the job is over", options);
  add_control(*rig, "acknowledge", "opens the latch after an alarm whose cause is gone", options);

  CLI::App* watch_command =
      rig->add_subcommand("watch", "follows the job to its end: exit 0 when it is done");
  add_connection_options(*watch_command, options);
  watch_command->add_option("--token-file", options->token_file, "not needed for watching");
  watch_command->add_option("--interval", options->interval_ms, "milliseconds between two looks")
      ->check(CLI::Range(50, 60000))
      ->capture_default_str();
  watch_command->callback([options] {
    Daemon daemon(options->url);
    watch(daemon, *options);
  });
}

}  // namespace biotomy::tools
