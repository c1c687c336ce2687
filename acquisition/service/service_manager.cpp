#include "acquisition/service/service_manager.hpp"

#include <cstdint>

#include <systemd/sd-daemon.h>

namespace biotomy::acquisition {
namespace {

void notify(const std::string& message) {
  sd_notify(0, message.c_str());
}

}  // namespace

ServiceManager::ServiceManager() {
  std::uint64_t period_us = 0;
  if (sd_watchdog_enabled(0, &period_us) > 0) {
    watchdog_period_ = std::chrono::microseconds(period_us);
  }
}

void ServiceManager::ready() {
  notify("READY=1");
}

void ServiceManager::status(const std::string& text) {
  if (text == last_status_) return;
  last_status_ = text;
  notify("STATUS=" + text);
}

void ServiceManager::alive() const {
  if (watchdog_period_) notify("WATCHDOG=1");
}

void ServiceManager::stopping() {
  notify("STOPPING=1");
}

void ServiceManager::extend(std::chrono::milliseconds time) const {
  notify("EXTEND_TIMEOUT_USEC=" + std::to_string(std::chrono::microseconds(time).count()));
}

std::string status_line(const JobStatus& status) {
  std::string text = to_string(status.state);
  if (status.layer > 0) text += ", layer " + std::to_string(status.layer);
  if (status.layer > 0) text += " of " + std::to_string(status.layers);
  text += ", " + std::to_string(status.committed) + " stored";
  if (!status.waiting_for.empty()) text += "; " + status.waiting_for;
  if (status.alarm) text += "; alarm: " + status.alarm->cause;
  for (char& character : text) {
    if (character == '\n' || character == '\r') character = ' ';  // it would begin another word
  }
  return text;
}

}  // namespace biotomy::acquisition
