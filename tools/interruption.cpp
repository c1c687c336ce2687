#include "tools/interruption.hpp"

#include <cstddef>

namespace biotomy::tools {
namespace {

constexpr std::array<int, 2> kSignals{SIGINT, SIGTERM};

volatile std::sig_atomic_t was_asked = 0;

extern "C" void ask_for_an_end(int /*signal*/) {
  was_asked = 1;
}

}  // namespace

Interruption::Interruption() {
  was_asked = 0;
  struct sigaction action {};
  action.sa_handler = ask_for_an_end;
  action.sa_flags = static_cast<int>(SA_RESETHAND);
  sigemptyset(&action.sa_mask);
  for (std::size_t i = 0; i < kSignals.size(); ++i) {
    sigaction(kSignals[i], &action, &before_[i]);
  }
}

Interruption::~Interruption() {
  for (std::size_t i = 0; i < kSignals.size(); ++i) {
    sigaction(kSignals[i], &before_[i], nullptr);
  }
}

bool Interruption::asked() const {
  return was_asked != 0;
}

}  // namespace biotomy::tools
