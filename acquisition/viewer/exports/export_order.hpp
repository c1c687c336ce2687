#pragma once

#include <optional>
#include <string>

#include "acquisition/viewer/live_sample.hpp"
#include "acquisition/viewer/section_query.hpp"
#include "acquisition/viewer/series_query.hpp"

namespace biotomy::acquisition {

/// What is to be exported.
struct ExportOrder {
  std::optional<SectionQuery> section;  ///< one of the two is there
  std::optional<SeriesQuery> series;
  bool frames = false;  ///< of a series: its pictures, in an archive
  bool movie = false;   ///< of a series: its film
  double rate = 25.0;   ///< frames of the film in a second
};

/// The body of POST /api/v1/exports. Throws InvalidRequest that says what is wrong with it.
ExportOrder export_order(const std::string& body);

/// What is known of an export before it is made.
struct ExportPlan {
  std::int64_t total = 0;   ///< rows of a section, frames of a series
  std::string unit;         ///< "rows" or "frames"
  std::uint64_t bytes = 0;  ///< that its files may take: about, rather too much
  std::string command;      ///< the command line that makes the same
};

/// Throws InvalidRequest, and SampleError where the sample has no such picture, or it would be
/// larger than `max_bytes` in memory; Refusal where a series has too many frames.
ExportPlan export_plan(const ExportOrder& order, const SampleView& view, std::int64_t max_bytes);

}  // namespace biotomy::acquisition
