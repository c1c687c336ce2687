#include "tools/picture_options.hpp"

#include <cmath>

#include <CLI/CLI.hpp>

#include "reconstruct/errors.hpp"
#include "reconstruct/section/parameter_text.hpp"

namespace biotomy::tools {

void add_picture_options(CLI::App& command, PictureOptions& options) {
  command.add_option("--quality", options.quality, "Of a JPEG, 1 to 100")->capture_default_str();
}

int jpeg_quality(const PictureOptions& options) {
  const double quality = reconstruct::parse_number("--quality", options.quality);
  if (quality < 1.0 || quality > 100.0 || quality != std::floor(quality)) {
    throw reconstruct::InvalidRequest("--quality '" + options.quality +
                                      "': give a whole number from 1 to 100");
  }
  return static_cast<int>(quality);
}

}  // namespace biotomy::tools
