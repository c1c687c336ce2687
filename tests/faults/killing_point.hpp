#pragma once

#include <string>
#include <vector>

namespace biotomy::tests {

/// The environment in which killing_point.cpp ends a program at a point: by SIGKILL, as a power cut
/// or the kernel's out-of-memory killer would. A point is a list of steps, separated by "; ", that
/// have to be reached in this order; the last one kills.
///
///   STEP = before|amid|after CALL PATTERN [N]
///
/// - CALL is create, write, sync, read, rename, unlink or send, whichever function of the C
///   library does it;
/// - PATTERN, with * and ?, is matched against the whole path of the file or folder (of `rename`
///   against the new name); of `send` against the bytes in hexadecimal;
/// - N: the N-th such call since the step before it was reached, the first if none is given;
/// - before: it is not made; after: it was; amid: half of the bytes of a `write` are written.
inline std::vector<std::string> killed_at(const std::string& point) {
  return {"LD_PRELOAD=" BIOTOMY_KILLING_POINT, "BIOTOMY_KILLING_POINT=" + point};
}

}  // namespace biotomy::tests
