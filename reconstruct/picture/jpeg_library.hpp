#pragma once

#include <array>
#include <csetjmp>
#include <cstddef>
#include <cstdio>

#include <jpeglib.h>

namespace biotomy::reconstruct {

/// libjpeg's way to report: the first error or warning is kept, nothing is printed, and an error
/// jumps to `place`, since libjpeg expects no return from it.
struct JpegReport {
  JpegReport();

  /// The first error or warning since it was made; empty if none.
  const char* message() const { return text.data(); }

  jpeg_error_mgr manager{};  // first: libjpeg hands a pointer to it back to us
  std::jmp_buf place{};
  bool hears_of_extraneous_bytes = true;  ///< before a marker; if not, they are no warning
  std::array<char, JMSG_LENGTH_MAX> text{};
};

}  // namespace biotomy::reconstruct
