#include <iostream>
#include <stdexcept>
#include <string>

#include <CLI/CLI.hpp>

#include "acquisition/job/state_diagram.hpp"
#include "acquisition/log.hpp"
#include "acquisition/service/configuration.hpp"
#include "acquisition/service/configuration_reference.hpp"
#include "acquisition/service/daemon.hpp"

namespace {

using namespace biotomy::acquisition;

constexpr int kFailure = 1;
constexpr int kUsage = 2;

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"Runs a grinding rig: grinds, photographs and stores, layer by layer."};
  app.set_version_flag("--version", BIOTOMY_VERSION);
  std::string file;
  bool reference = false;
  bool diagram = false;
  bool test = false;
  auto* config = app.add_option("--config", file, "the configuration, rig.toml");
  app.add_flag("--configuration-reference", reference,
               "print every key of the configuration (Markdown) and end")
      ->excludes(config);
  app.add_flag("--state-diagram", diagram, "print the states of a job (Markdown) and end")
      ->excludes(config);
  app.add_flag("--test-notification", test,
               "send a notification as [notify] of the configuration says, and end");
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
    const Configuration configuration = read_configuration(file);
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
    std::cerr << "biotomyd: " << error.what() << '\n';
    return kFailure;
  }
}
