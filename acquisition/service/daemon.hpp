#pragma once

#include "acquisition/service/configuration.hpp"

namespace biotomy::acquisition {

/// Runs the rig as configured until a signal or a failure ends it. Returns the program's exit code.
int run_daemon(const Configuration& configuration);

/// Sends a test notification over every configured way and prints how it went. Returns the
/// program's exit code.
int test_notification(const Configuration& configuration);

}  // namespace biotomy::acquisition
