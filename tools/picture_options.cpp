#include "tools/picture_options.hpp"

#include <CLI/CLI.hpp>

#include "reconstruct/section/section_parameters.hpp"

namespace biotomy::tools {

void add_picture_options(CLI::App& command, PictureOptions& options) {
  command.add_option("--quality", options.quality, "Of a JPEG, 1 to 100")->capture_default_str();
}

int jpeg_quality(const PictureOptions& options) {
  return reconstruct::parse_quality("--quality", options.quality);
}

}  // namespace biotomy::tools
