#pragma once

namespace biotomy::tools {

/// While it lives, the first SIGINT and the first SIGTERM are remembered instead of ending the
/// program, so that work can be left in order; a second one of the kind ends it at once. One at a
/// time.
class Interruption {
 public:
  Interruption();
  ~Interruption();
  Interruption(const Interruption&) = delete;
  Interruption& operator=(const Interruption&) = delete;

  /// Whether a signal came. Any thread may ask.
  static bool requested();
};

}  // namespace biotomy::tools
