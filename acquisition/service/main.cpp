#include <iostream>
#include <stdexcept>
#include <string>

#include <CLI/CLI.hpp>

#include "acquisition/job/state_diagram.hpp"
#include "acquisition/log.hpp"
#include "acquisition/service/configuration.hpp"
#include "acquisition/service/configuration_reference.hpp"
#include "acquisition/service/daemon.hpp"
#include "acquisition/service/device_list.hpp"
#include "acquisition/service/quality_section.hpp"
#include "acquisition/service/rig_check.hpp"
#include "reconstruct/failure_text.hpp"

namespace {

using namespace biotomy::acquisition;

constexpr int kFailure = 1;
constexpr int kUsage = 2;

int list_devices(bool as_json) {
  const DeviceList found = find_devices();
  std::cout << (as_json ? devices_json(found) : devices_text(found));
  return 0;
}

int check_configuration(const std::string& file, bool as_json) {
  log_to_stderr();
  const Configuration configuration = read_configuration(file);
  const RigFindings found = check_rig(configuration, real_check_parts(configuration));
  std::cout << (as_json ? findings_json(found) : findings_text(found));
  return found.can_start() ? 0 : kFailure;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"Runs a grinding rig: grinds, photographs and stores, layer by layer."};
  app.set_version_flag("--version", BIOTOMY_VERSION);
  std::string file;
  bool reference = false;
  bool diagram = false;
  bool test = false;
  bool list = false;
  bool as_json = false;
  std::string checked_file;
  std::string qc_policy;
  auto* config = app.add_option("--config", file, "the configuration, rig.toml");
  app.add_option("--qc-policy", qc_policy,
                 "instead of the configuration's quality.policy, when no photograph of a layer was "
                 "good enough: pause the rig, or accept the sharpest with a flag if it lacks "
                 "nothing but sharpness")
      ->check(CLI::IsMember({"pause", "accept"}))
      ->needs(config);
  app.add_flag("--configuration-reference", reference,
               "print every key of the configuration (Markdown) and end")
      ->excludes(config);
  app.add_flag("--state-diagram", diagram, "print the states of a job (Markdown) and end")
      ->excludes(config);
  app.add_flag("--test-notification", test,
               "send a notification as [notify] of the configuration says, and end");
  auto* check = app.add_option("--check", checked_file,
                               "ask every device of this configuration what it is and how it is, "
                               "say what is wrong, and end; nothing moves")
                    ->excludes(config);
  auto* devices = app.add_flag("--list-devices", list,
                               "print the cameras, GPIO lines and serial ports of this computer "
                               "that a configuration could name, and end")
                      ->excludes(config)
                      ->excludes(check);
  auto* json = app.add_flag("--json", as_json, "of --check and --list-devices: print JSON");
  try {
    app.parse(argc, argv);
    if (json->count() > 0 && check->count() + devices->count() == 0) {
      throw CLI::RequiredError("--json is of --check and --list-devices; one of them");
    }
    if (list) return list_devices(as_json);
    if (check->count() > 0) return check_configuration(checked_file, as_json);
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
    Configuration configuration = read_configuration(file);
    if (!qc_policy.empty()) configuration.job.ladder.exhausted = exhausted_policy(qc_policy);
    return test ? test_notification(configuration) : run_daemon(configuration);
  } catch (const CLI::Success& request) {  // --help, --version
    return app.exit(request);
  } catch (const CLI::ParseError& error) {
    std::cerr << "biotomyd: " << error.what() << '\n';
    return kUsage;
  } catch (const std::invalid_argument& error) {
    std::cerr << "biotomyd: " << error.what() << '\n';
    return kUsage;
  } catch (const std::exception& error) {
    std::cerr << "biotomyd: " << biotomy::reconstruct::failure_text(error) << '\n';
    return kFailure;
  }
}
