#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <vector>

#include "acquisition/viewer/exports/export_order.hpp"
#include "acquisition/viewer/exports/export_record.hpp"
#include "acquisition/viewer/live_sample.hpp"

namespace biotomy::acquisition {

/// What the work on an export is bound by, and whom it tells how far it is.
struct ExportBounds {
  std::int64_t max_bytes = 0;     ///< of a picture in memory
  std::size_t cache_bytes = 0;    ///< of decoded chunks
  std::function<void()> look_up;  ///< called often, at most a piece of work apart; throws to end it
  std::function<void(std::int64_t done, std::int64_t total)> progress;
};

/// Makes the files of an export in `folder`, the same ones as the command does. Throws what
/// sections, series and films throw, and what `look_up` throws.
std::vector<ExportFile> make_export(const ExportOrder& order, const SampleView& view,
                                    const std::filesystem::path& folder,
                                    const ExportBounds& bounds);

}  // namespace biotomy::acquisition
