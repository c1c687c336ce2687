#pragma once

#include <filesystem>
#include <memory>

#include "firmware_bridge/lines/gpio_chips.hpp"

namespace biotomy::bridge {

/// What each version of libgpiod does in its own way: GpioChips::describe, request_input and
/// request_output, with their errors.
GpioChipInfo describe_gpio_chip(const std::filesystem::path& device);
std::unique_ptr<GpioInput> hold_gpio_input(const GpioRequest& request);
std::unique_ptr<GpioOutput> hold_gpio_output(const GpioRequest& request);

/// Whether a read of `descriptor` would not wait: there is data, or an error to fetch.
/// Throws std::system_error.
bool is_readable_now(int descriptor);

}  // namespace biotomy::bridge
