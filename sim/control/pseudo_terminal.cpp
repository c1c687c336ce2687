#include "sim/control/pseudo_terminal.hpp"

#include <array>
#include <cerrno>
#include <cstdlib>
#include <system_error>

#include <fcntl.h>
#include <termios.h>

namespace biotomy::sim {

namespace {

[[noreturn]] void fail(const std::filesystem::path& what) {
  throw std::system_error(errno, std::generic_category(), what.string());
}

}  // namespace

PseudoTerminal::PseudoTerminal(const std::filesystem::path& link)
    : link_(link), near_(posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC)) {
  std::array<char, 64> name{};
  if (!near_.valid() || grantpt(near_.get()) != 0 || unlockpt(near_.get()) != 0 ||
      ptsname_r(near_.get(), name.data(), name.size()) != 0) {
    fail("a pseudo-terminal");
  }
  device_ = name.data();
  far_ = bridge::UniqueFd(open(device_.c_str(), O_RDWR | O_NOCTTY | O_CLOEXEC));
  termios attributes{};
  if (!far_.valid() || tcgetattr(far_.get(), &attributes) != 0) {
    fail(device_);
  }
  cfmakeraw(&attributes);
  if (tcsetattr(far_.get(), TCSANOW, &attributes) != 0) {
    fail(device_);
  }
  if (std::filesystem::is_symlink(link_)) {
    std::filesystem::remove(link_);
  }
  std::filesystem::create_symlink(device_, link_);
}

PseudoTerminal::~PseudoTerminal() {
  std::error_code ignored;
  if (std::filesystem::read_symlink(link_, ignored) == device_) {
    std::filesystem::remove(link_, ignored);
  }
}

}  // namespace biotomy::sim
