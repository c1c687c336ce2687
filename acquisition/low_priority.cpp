#include "acquisition/low_priority.hpp"

#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>

namespace biotomy::acquisition {
namespace {

// Of the kernel's linux/ioprio.h, which not every Debian installs for programs.
constexpr int kIoPriorityOfAThread = 1;
constexpr int kIoBestEffortLast = (2 << 13) | 7;
constexpr int kIoIdle = 3 << 13;

}  // namespace

void lower_priority(int nice, DiskShare disk) {
  const auto thread = static_cast<id_t>(::gettid());
  ::setpriority(PRIO_PROCESS, thread, ::getpriority(PRIO_PROCESS, thread) + nice);
  ::syscall(SYS_ioprio_set, kIoPriorityOfAThread, thread,
            disk == DiskShare::idle ? kIoIdle : kIoBestEffortLast);
}

}  // namespace biotomy::acquisition
