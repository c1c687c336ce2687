#include "tools/interruption.hpp"

#include <array>
#include <atomic>
#include <csignal>

namespace biotomy::tools {
namespace {

constexpr std::array kSignals{SIGINT, SIGTERM};

std::atomic<bool> signalled{false};
static_assert(std::atomic<bool>::is_always_lock_free);  // or a handler must not touch it

void remember(int /*signal*/) {
  signalled = true;
}

}  // namespace

Interruption::Interruption() {
  signalled = false;
  struct sigaction action {};
  action.sa_handler = remember;
  action.sa_flags = SA_RESTART | static_cast<int>(SA_RESETHAND);
  sigemptyset(&action.sa_mask);
  for (const int signal : kSignals) {
    ::sigaction(signal, &action, nullptr);
  }
}

Interruption::~Interruption() {
  for (const int signal : kSignals) {
    std::signal(signal, SIG_DFL);
  }
}

bool Interruption::requested() {
  return signalled;
}

}  // namespace biotomy::tools
