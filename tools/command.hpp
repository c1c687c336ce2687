#pragma once

#include <CLI/CLI.hpp>

namespace biotomy::tools {

/// Each adds its subcommand to the application; the subcommand's work runs in its callback.
/// What goes wrong is thrown: InvalidRequest (exit code 2) or any other std::exception (1), with a
/// message of one line.
void add_import_command(CLI::App& app);
void add_info_command(CLI::App& app);
void add_section_command(CLI::App& app);
void add_series_command(CLI::App& app);
void add_verify_command(CLI::App& app);
void add_rebuild_command(CLI::App& app);
void add_export_command(CLI::App& app);
void add_rig_command(CLI::App& app);
void add_qc_command(CLI::App& app);
void add_calibrate_command(CLI::App& app);
void add_view_command(CLI::App& app);

}  // namespace biotomy::tools
