#include "reconstruct/absolute_folder.hpp"

namespace biotomy::reconstruct {

std::filesystem::path absolute_folder(const std::filesystem::path& folder) {
  const std::filesystem::path path = std::filesystem::absolute(folder).lexically_normal();
  return path.has_filename() ? path : path.parent_path();
}

}  // namespace biotomy::reconstruct
