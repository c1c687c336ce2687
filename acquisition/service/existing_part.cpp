#include "acquisition/service/existing_part.hpp"

#include <system_error>

namespace biotomy::acquisition {

std::filesystem::path existing_part(std::filesystem::path path) {
  std::error_code error;
  while (!std::filesystem::exists(path, error) && path.has_relative_path()) {
    path = path.parent_path();
  }
  return path;
}

}  // namespace biotomy::acquisition
