#pragma once

#include <string>

namespace biotomy::acquisition {

/// The log goes to stderr, a line an event. Without this call it goes to stdout, as spdlog's does.
void log_to_stderr();

/// One line of the daemon's log, under the name of the component that says it ("job", "http").
void log_info(const char* component, const std::string& text);
void log_warning(const char* component, const std::string& text);
void log_error(const char* component, const std::string& text);

}  // namespace biotomy::acquisition
