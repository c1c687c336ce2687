#pragma once

#include <array>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <minizip/unzip.h>

namespace biotomy::acquisition {

/// Names and contents of a ZIP archive's files, in their order; their checksums are looked at.
inline std::vector<std::pair<std::string, std::string>> archive_content(
    const std::filesystem::path& path) {
  unzFile zip = unzOpen64(path.c_str());
  if (zip == nullptr) throw std::runtime_error(path.string() + " is no archive");
  std::vector<std::pair<std::string, std::string>> files;
  for (int at = unzGoToFirstFile(zip); at == UNZ_OK; at = unzGoToNextFile(zip)) {
    unz_file_info64 info{};
    std::array<char, 256> name{};
    unzGetCurrentFileInfo64(zip, &info, name.data(), name.size(), nullptr, 0, nullptr, 0);
    std::string content(info.uncompressed_size, '\0');
    unzOpenCurrentFile(zip);
    const int read = unzReadCurrentFile(zip, content.data(), static_cast<unsigned>(content.size()));
    if (read != static_cast<int>(content.size()) || unzCloseCurrentFile(zip) != UNZ_OK) {
      throw std::runtime_error(std::string(name.data()) + " is damaged");
    }
    files.emplace_back(name.data(), std::move(content));
  }
  unzClose(zip);
  return files;
}

}  // namespace biotomy::acquisition
