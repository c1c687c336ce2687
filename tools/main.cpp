#include <exception>
#include <iostream>
#include <stdexcept>
#include <string>

#include <CLI/CLI.hpp>

#include "reconstruct/failure_text.hpp"
#include "tools/command.hpp"

namespace {

constexpr int kFailure = 1;
constexpr int kUsage = 2;

int fail(int code, const std::string& what) {
  std::cerr << "biotomy: " << what << '\n';
  return code;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"Turns photographs of a ground block into a volume and cuts it along any plane."};
  app.set_version_flag("--version", BIOTOMY_VERSION);
  app.require_subcommand(0, 1);
  biotomy::tools::add_import_command(app);
  biotomy::tools::add_info_command(app);
  biotomy::tools::add_section_command(app);
  biotomy::tools::add_series_command(app);
  biotomy::tools::add_verify_command(app);
  biotomy::tools::add_rebuild_command(app);
  biotomy::tools::add_export_command(app);
  biotomy::tools::add_qc_command(app);
  biotomy::tools::add_rig_command(app);
  biotomy::tools::add_calibrate_command(app);
  biotomy::tools::add_view_command(app);
  try {
    app.parse(argc, argv);
    // Asked here and not by CLI11, which would say this of a misspelt command too.
    if (app.get_subcommands().empty()) return fail(kUsage, "say what to do; see biotomy --help");
  } catch (const CLI::Success& request) {  // --help, --version
    const int code = app.exit(request);
    return std::cout.flush() ? code : fail(kFailure, "standard output takes no more");
  } catch (const CLI::ParseError& error) {
    return fail(kUsage, error.what());
  } catch (const std::invalid_argument& error) {
    return fail(kUsage, error.what());
  } catch (const std::exception& error) {
    return fail(kFailure, biotomy::reconstruct::failure_text(error));
  }
  // What was asked for may have gone to a file on a full disk.
  if (!std::cout.flush()) return fail(kFailure, "standard output takes no more: is its disk full?");
  return 0;
}
