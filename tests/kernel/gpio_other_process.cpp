#include "tests/kernel/gpio_other_process.hpp"

#include <algorithm>
#include <array>
#include <csignal>
#include <cstdio>
#include <exception>
#include <stdexcept>
#include <utility>

#include <fcntl.h>
#include <linux/gpio.h>
#include <sys/ioctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include "firmware_bridge/wire/unique_fd.hpp"

namespace biotomy::tests {

namespace {

[[noreturn]] void live(const GpioOtherProcess::Task& task, const bridge::UniqueFd& ready) {
  try {
    task([&ready] {
      if (::write(ready.get(), "r", 1) != 1) ::_exit(1);
      while (true) ::pause();
    });
  } catch (const std::exception& error) {
    std::fprintf(stderr, "the other process: %s\n", error.what());
  }
  ::_exit(1);
}

}  // namespace

GpioOtherProcess::GpioOtherProcess(const Task& task) {
  std::array<int, 2> ends{};
  if (::pipe2(ends.data(), O_CLOEXEC) != 0) throw std::runtime_error("no pipe to be had");
  const bridge::UniqueFd reading(ends[0]);
  bridge::UniqueFd writing(ends[1]);
  process_ = ::fork();
  if (process_ < 0) throw std::runtime_error("no process to be had");
  if (process_ == 0) live(task, writing);
  writing.reset();
  char sign = 0;
  if (::read(reading.get(), &sign, 1) != 1) {
    kill();
    throw std::runtime_error("the other process ended before it was ready");
  }
}

void GpioOtherProcess::kill() {
  if (process_ < 0) return;
  ::kill(process_, SIGKILL);
  ::waitpid(std::exchange(process_, -1), nullptr, 0);
}

GpioOtherProcess::Task GpioOtherProcess::holds(const std::filesystem::path& device,
                                               unsigned int offset, const std::string& consumer) {
  // By the kernel's own interface: our sources always give our own name.
  return [=](const std::function<void()>& ready) {
    const bridge::UniqueFd chip(::open(device.c_str(), O_RDWR | O_CLOEXEC));
    gpio_v2_line_request request{};
    request.offsets[0] = offset;
    request.num_lines = 1;
    request.config.flags = GPIO_V2_LINE_FLAG_INPUT;
    std::copy_n(consumer.data(), std::min(consumer.size(), sizeof(request.consumer) - 1),
                request.consumer);
    if (::ioctl(chip.get(), GPIO_V2_GET_LINE_IOCTL, &request) != 0) {
      throw std::runtime_error("cannot hold the line");
    }
    const bridge::UniqueFd line(request.fd);
    ready();
  };
}

}  // namespace biotomy::tests
