#include "tests/kernel/gpio_sim_chip.hpp"

#include <cerrno>
#include <fstream>
#include <stdexcept>
#include <system_error>

#include <unistd.h>

namespace biotomy::tests {

namespace {

constexpr const char* kConfiguration = "/sys/kernel/config/gpio-sim";

/// The kernel's files want a whole value in one write, and answer by its error.
void write_value(const std::filesystem::path& file, const std::string& value) {
  std::ofstream stream(file);
  stream << value << std::flush;
  if (!stream) {
    throw std::runtime_error(file.string() + ": cannot write \"" + value +
                             "\": " + std::generic_category().message(errno));
  }
}

std::string read_value(const std::filesystem::path& file) {
  std::ifstream stream(file);
  std::string value;
  if (!std::getline(stream, value)) throw std::runtime_error(file.string() + ": cannot be read");
  return value;
}

}  // namespace

std::string GpioSimChip::missing() {
  if (!std::filesystem::exists(kConfiguration)) {
    return std::string("no gpio-sim: there is no ") + kConfiguration +
           " (modprobe gpio-sim; mount -t configfs none /sys/kernel/config)";
  }
  if (::geteuid() != 0) return "gpio-sim chips can be made by root alone";
  return "";
}

GpioSimChip::GpioSimChip(std::string label, const std::vector<std::string>& line_names)
    : label_(std::move(label)),
      folder_(std::filesystem::path(kConfiguration) / label_),
      bank_(folder_ / "bank0"),
      lines_(line_names.size()) {
  std::filesystem::create_directory(folder_);
  std::filesystem::create_directory(bank_);
  write_value(bank_ / "label", label_);
  write_value(bank_ / "num_lines", std::to_string(lines_));
  for (std::size_t offset = 0; offset < lines_; ++offset) {
    if (line_names[offset].empty()) continue;
    const std::filesystem::path line = bank_ / ("line" + std::to_string(offset));
    std::filesystem::create_directory(line);
    write_value(line / "name", line_names[offset]);
  }
  plug_in();
}

GpioSimChip::~GpioSimChip() {
  try {
    if (read_value(folder_ / "live") == "1") unplug();
    for (std::size_t offset = 0; offset < lines_; ++offset) {
      std::error_code unnamed;  // a line without a name has no folder
      std::filesystem::remove(bank_ / ("line" + std::to_string(offset)), unnamed);
    }
    std::filesystem::remove(bank_);
    std::filesystem::remove(folder_);
  } catch (const std::exception&) {
    // The chip stays behind until the machine is restarted; a destructor can't tell.
  }
}

void GpioSimChip::unplug() {
  write_value(folder_ / "live", "0");
}

void GpioSimChip::plug_in() {
  write_value(folder_ / "live", "1");
  name_ = read_value(bank_ / "chip_name");
  controls_ =
      std::filesystem::path("/sys/devices/platform") / read_value(folder_ / "dev_name") / name_;
}

void GpioSimChip::pull(unsigned int offset, bool high) {
  write_value(line_folder(offset) / "pull", high ? "pull-up" : "pull-down");
}

bool GpioSimChip::is_high(unsigned int offset) const {
  return read_value(line_folder(offset) / "value") == "1";
}

std::filesystem::path GpioSimChip::line_folder(unsigned int offset) const {
  return controls_ / ("sim_gpio" + std::to_string(offset));
}

}  // namespace biotomy::tests
