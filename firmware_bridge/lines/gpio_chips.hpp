#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "firmware_bridge/lines/gpio_line_settings.hpp"

namespace biotomy::bridge {

/// The name under which the kernel lists the lines that we hold.
inline constexpr const char* kGpioConsumer = "biotomyd";

struct GpioLineInfo {
  std::string name;  ///< empty: it has none
  bool is_output = false;
  bool is_used = false;  ///< held by a process or by the kernel itself
  std::string consumer;  ///< who holds it, as far as that one gave a name
};

struct GpioChipInfo {
  std::filesystem::path device;     ///< "/dev/gpiochip0"
  std::string name;                 ///< "gpiochip0"
  std::string label;                ///< the driver's name for it, as "pinctrl-bcm2711"
  std::vector<GpioLineInfo> lines;  ///< by offset
};

/// What is asked of the kernel for one line.
struct GpioRequest {
  std::filesystem::path device;
  unsigned int offset = 0;
  bool active_low = false;
  LineBias bias = LineBias::as_is;
  bool edges = false;  ///< of an input: keep its edges
};

/// An input that this process holds until the object is destroyed. What fails throws
/// std::system_error (ENODEV: the chip went away).
class GpioInput {
 public:
  virtual ~GpioInput() = default;
  /// Whether there were edges since the last call; they are taken out of the kernel's queue, which
  /// keeps 16. Never waits. Always false without GpioRequest::edges.
  virtual bool take_edges() = 0;
  /// The level at this moment, polarity applied.
  virtual bool is_active() = 0;
};

/// An output that this process holds until the object is destroyed; it begins inactive. What a chip
/// does with a line that nobody holds is its own affair: some drive the last level on, others make
/// it an input. Throws as GpioInput does.
class GpioOutput {
 public:
  virtual ~GpioOutput() = default;
  virtual void set_active(bool active) = 0;
};

/// The GPIO chips of a computer: the little that differs between the versions of libgpiod, and
/// nothing else. What fails throws std::system_error with the kernel's error.
class GpioChips {
 public:
  virtual ~GpioChips() = default;
  /// The device files there are, by number. Some may not be ours to open.
  virtual std::vector<std::filesystem::path> devices() = 0;
  virtual GpioChipInfo describe(const std::filesystem::path& device) = 0;
  virtual std::unique_ptr<GpioInput> request_input(const GpioRequest& request) = 0;
  virtual std::unique_ptr<GpioOutput> request_output(const GpioRequest& request) = 0;
};

/// The chips of this computer, by the libgpiod that the build found (version 1 or 2).
std::unique_ptr<GpioChips> make_gpio_chips();

}  // namespace biotomy::bridge
