#include "acquisition/log.hpp"

#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

namespace biotomy::acquisition {
namespace {

void log(spdlog::level::level_enum level, const char* component, const std::string& text) {
  spdlog::log(level, "[{}] {}", component, text);
}

}  // namespace

void log_to_stderr() {
  spdlog::set_default_logger(spdlog::stderr_color_mt("biotomyd"));
  spdlog::set_pattern("%Y-%m-%dT%H:%M:%S.%e %l %v");
}

void log_info(const char* component, const std::string& text) {
  log(spdlog::level::info, component, text);
}

void log_warning(const char* component, const std::string& text) {
  log(spdlog::level::warn, component, text);
}

void log_error(const char* component, const std::string& text) {
  log(spdlog::level::err, component, text);
}

}  // namespace biotomy::acquisition
