#pragma once

#include <stdexcept>

#include <unistd.h>

namespace biotomy::tests {

/// While one is alive, this process, which is root's, acts as a user who is nobody.
class AnotherUser {
 public:
  static constexpr uid_t kNumber = 12345;

  /// Only root can become another, and give files to others.
  static bool can_be() { return ::geteuid() == 0; }

  AnotherUser() {
    if (::setegid(kNumber) != 0 || ::seteuid(kNumber) != 0) {
      throw std::runtime_error("cannot act as another user");
    }
  }
  ~AnotherUser() {
    if (::seteuid(0) != 0 || ::setegid(0) != 0) ::_exit(1);
  }
  AnotherUser(const AnotherUser&) = delete;
  AnotherUser& operator=(const AnotherUser&) = delete;
};

}  // namespace biotomy::tests
