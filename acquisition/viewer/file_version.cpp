#include "acquisition/viewer/file_version.hpp"

namespace biotomy::acquisition {

std::string file_version(const std::filesystem::path& file) {
  struct stat status {};
  return ::stat(file.c_str(), &status) == 0 ? file_version(status) : "";
}

std::string file_version(const struct stat& status) {
  return std::to_string(status.st_ino) + '-' + std::to_string(status.st_size) + '-' +
         std::to_string(status.st_mtim.tv_sec) + '.' + std::to_string(status.st_mtim.tv_nsec);
}

}  // namespace biotomy::acquisition
