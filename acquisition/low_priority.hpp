#pragma once

namespace biotomy::acquisition {

/// What is left of the disk for a thread.
enum class DiskShare {
  last,  ///< of those that read and write by usual right
  idle   ///< when nobody else wants it
};

/// Gives the calling thread less of the processor, by `nice`, and of the disk than everybody else
/// gets. Where the system does not let it, the work is done as well, only with less regard for the
/// rest.
void lower_priority(int nice, DiskShare disk);

}  // namespace biotomy::acquisition
