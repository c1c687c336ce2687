#include "acquisition/service/room_for_exports.hpp"

#include <algorithm>
#include <optional>

#include <sys/stat.h>

namespace biotomy::acquisition {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t kLeftFree = std::uint64_t{1} << 30;

/// The folder, or the one above it that is there.
fs::path existing_part(fs::path path) {
  std::error_code error;
  while (!fs::exists(path, error) && path != path.parent_path()) path = path.parent_path();
  return path;
}

std::optional<dev_t> disk_of(const fs::path& path) {
  struct stat status {};
  return ::stat(path.c_str(), &status) == 0 ? std::optional(status.st_dev) : std::nullopt;
}

std::uint64_t all_but_some(std::uint64_t free) {
  return free > kLeftFree ? free - kLeftFree : 0;
}

}  // namespace

std::uint64_t bytes_left_by_job(const JobStatus& status, std::int64_t reserve_layers,
                                std::uint64_t free) {
  if (!status.disk_left_layers || *status.disk_left_layers <= 0) {
    return status.disk_left_layers ? 0 : all_but_some(free);
  }
  const std::int64_t layers = *status.disk_left_layers;
  const std::int64_t needed =
      std::max<std::int64_t>(status.layers - status.committed, 0) + reserve_layers;
  const double left =
      static_cast<double>(std::max<std::int64_t>(layers - needed, 0)) / static_cast<double>(layers);
  return std::min(static_cast<std::uint64_t>(left * static_cast<double>(free)), all_but_some(free));
}

std::uint64_t room_for_exports(const fs::path& exports, const fs::path& sample,
                               const JobStatus& status, std::int64_t reserve_layers) {
  const fs::path folder = existing_part(exports);
  std::error_code error;
  const fs::space_info space = fs::space(folder, error);
  if (error) return 0;
  const bool shared = disk_of(folder) == disk_of(existing_part(sample));
  return shared ? bytes_left_by_job(status, reserve_layers, space.available)
                : all_but_some(space.available);
}

}  // namespace biotomy::acquisition
