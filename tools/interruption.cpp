#include "tools/interruption.hpp"

#include <atomic>
#include <cstddef>

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
  for (std::size_t i = 0; i < kSignals.size(); ++i) {
    ::sigaction(kSignals[i], &action, &before_[i]);
  }
}

Interruption::~Interruption() {
  for (std::size_t i = 0; i < kSignals.size(); ++i) {
    ::sigaction(kSignals[i], &before_[i], nullptr);
  }
}

bool Interruption::requested() {
  return signalled;
}

}  // namespace biotomy::tools
