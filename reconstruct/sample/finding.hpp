#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>

namespace biotomy::reconstruct {

/// Something that is wrong with a sample, and the file or folder that it is wrong with.
struct Finding {
  std::filesystem::path file;
  std::string what;
};

/// What those who verify a part of a sample tell; each is called by one thread at a time.
struct VerificationListener {
  std::function<void(const Finding&)> found;
  std::function<void(std::int64_t done, std::int64_t total)> progress;
};

}  // namespace biotomy::reconstruct
