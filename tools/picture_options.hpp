#pragma once

#include <string>

namespace CLI {
class App;
}

namespace biotomy::tools {

/// The options that all commands that write pictures have, as they were typed.
struct PictureOptions {
  std::string quality = "90";
};

void add_picture_options(CLI::App& command, PictureOptions& options);

/// Throws InvalidRequest that names the option.
int jpeg_quality(const PictureOptions& options);

}  // namespace biotomy::tools
