#pragma once

#include <string>

#include <unistd.h>

#include "acquisition/http/message.hpp"

namespace biotomy::tests {

/// What is sent of a file.
inline std::string content_of(const acquisition::FilePart& part) {
  std::string content(part.bytes, '\0');
  const ssize_t read =
      ::pread(part.file->get(), content.data(), content.size(), static_cast<off_t>(part.begin));
  content.resize(read > 0 ? static_cast<std::size_t>(read) : 0);
  return content;
}

}  // namespace biotomy::tests
