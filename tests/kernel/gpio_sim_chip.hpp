#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace biotomy::tests {

/// A GPIO chip that the kernel's gpio-sim simulates, made by configfs and unmade with the object.
/// Its lines are pulled, and its outputs read, behind the back of whoever holds them, as wires do.
/// What fails throws std::runtime_error.
class GpioSimChip {
 public:
  /// Why there can be no such chip on this machine; empty if there can.
  static std::string missing();

  /// The chip is there and its lines are low; a line without a name gets an empty one.
  GpioSimChip(std::string label, const std::vector<std::string>& line_names);
  ~GpioSimChip();
  GpioSimChip(const GpioSimChip&) = delete;
  GpioSimChip& operator=(const GpioSimChip&) = delete;

  /// Unplug and replug: without its device file, and with a new one. The lines are low again.
  void unplug();
  void plug_in();

  const std::string& label() const { return label_; }
  const std::string& name() const { return name_; }  ///< "gpiochip0"; another one after a replug
  std::filesystem::path device() const { return "/dev/" + name_; }

  void pull(unsigned int offset, bool high);
  bool is_high(unsigned int offset) const;  ///< the voltage, of an output also

 private:
  std::filesystem::path line_folder(unsigned int offset) const;

  std::string label_;
  std::filesystem::path folder_;  ///< in configfs
  std::filesystem::path bank_;
  std::size_t lines_;
  std::string name_;
  std::filesystem::path controls_;  ///< in sysfs
};

}  // namespace biotomy::tests
