#pragma once

#include <filesystem>
#include <functional>
#include <string>

#include <sys/types.h>

namespace biotomy::tests {

/// Another process that holds GPIO lines until it is killed, at the latest with this object.
class GpioOtherProcess {
 public:
  /// Does what has to be done, calls `ready`, and does not return from that.
  using Task = std::function<void(const std::function<void()>& ready)>;

  /// Returns when the process is ready. Throws std::runtime_error if it ended before.
  explicit GpioOtherProcess(const Task& task);
  ~GpioOtherProcess() { kill(); }
  GpioOtherProcess(const GpioOtherProcess&) = delete;
  GpioOtherProcess& operator=(const GpioOtherProcess&) = delete;

  /// By SIGKILL; waits for its end.
  void kill();

  /// A task that holds one line as an input under the name `consumer`.
  static Task holds(const std::filesystem::path& device, unsigned int offset,
                    const std::string& consumer);

 private:
  pid_t process_ = -1;
};

}  // namespace biotomy::tests
