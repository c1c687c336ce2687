#pragma once

#include <memory>
#include <string>

namespace biotomy::bridge {

enum class LineBias { as_is, disabled, pull_up, pull_down };

struct GpioLineSettings {
  std::string chip;         ///< "gpiochip0", "/dev/gpiochip0" or the chip's label
  std::string line;         ///< the line's name, or its offset as a number
  bool active_low = false;  ///< a low voltage is "active"
  LineBias bias = LineBias::as_is;
};

/// One line of a GPIO chip, held by this process until it is destroyed. There is a source for each
/// generation of libgpiod; the build takes the one that fits the system.
class GpioLine {
 public:
  /// An output begins inactive. All three throw DeviceError: `configuration` for a chip or line
  /// that is not there or in use, `disconnected` for one that went away.
  static GpioLine input(const GpioLineSettings& settings);
  static GpioLine output(const GpioLineSettings& settings);

  bool is_active();
  void set_active(bool active);

  GpioLine(GpioLine&&) noexcept;
  GpioLine& operator=(GpioLine&&) noexcept;
  ~GpioLine();

 private:
  struct Request;
  explicit GpioLine(std::unique_ptr<Request> request);
  static GpioLine open(const GpioLineSettings& settings, bool is_output);

  std::unique_ptr<Request> request_;
};

}  // namespace biotomy::bridge
