#include "acquisition/service/spare_room.hpp"

#include <algorithm>
#include <optional>

#include <sys/stat.h>

#include "acquisition/service/existing_part.hpp"
#include "acquisition/viewer/viewer_settings.hpp"

namespace biotomy::acquisition {
namespace {

namespace fs = std::filesystem;

std::optional<dev_t> disk_of(const fs::path& path) {
  struct stat found {};
  if (::stat(path.c_str(), &found) != 0) return std::nullopt;
  return found.st_dev;
}

}  // namespace

std::uint64_t bytes_to_spare(std::uint64_t free, const JobStatus& status,
                             const SafetyLimits& limits) {
  if (!status.disk_left_layers) return free / 2;
  const auto room = static_cast<std::uint64_t>(std::max<std::int64_t>(*status.disk_left_layers, 0));
  const auto needed = static_cast<std::uint64_t>(
      std::max<std::int64_t>({status.layers - status.committed, limits.disk_reserve_layers, 0}));
  if (needed >= room) return 0;
  // Room for so many layers is what is free now; the last bit of it is no layer any more.
  return (room - needed) * (free / (room + 1));
}

std::uint64_t bytes_to_spare(const fs::path& folder, const fs::path& sample,
                             const JobStatus& status, const SafetyLimits& limits) {
  const fs::path there = existing_part(folder);
  std::error_code error;
  const fs::space_info space = fs::space(there, error);
  if (error) return 0;
  if (disk_of(there) == disk_of(existing_part(sample))) {
    return bytes_to_spare(space.available, status, limits);
  }
  return space.available > kLeftFree ? space.available - kLeftFree : 0;
}

}  // namespace biotomy::acquisition
