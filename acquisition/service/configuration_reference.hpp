#pragma once

#include <string>

namespace biotomy::acquisition {

/// The reference of every key of rig.toml, in Markdown: docs/configuration.md, word for word.
std::string configuration_reference();

}  // namespace biotomy::acquisition
