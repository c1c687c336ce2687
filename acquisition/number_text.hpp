#pragma once

#include <sstream>
#include <string>

namespace biotomy::acquisition {

/// A number as a sentence for people shows it: six digits at most, none that say nothing.
inline std::string number_text(double value) {
  std::ostringstream text;
  text << value;
  return text.str();
}

}  // namespace biotomy::acquisition
