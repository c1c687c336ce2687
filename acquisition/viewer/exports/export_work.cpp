#include "acquisition/viewer/exports/export_work.hpp"

#include <algorithm>
#include <optional>
#include <string>

#include "acquisition/viewer/exports/frame_archive.hpp"
#include "reconstruct/section/cache_need.hpp"
#include "reconstruct/section/film.hpp"
#include "reconstruct/section/section_record.hpp"
#include "reconstruct/section/series_frames.hpp"

namespace biotomy::acquisition {
namespace {

namespace fs = std::filesystem;

using reconstruct::VolumeBricks;

ExportFile file_of(const fs::path& path) {
  return {path.filename().string(), fs::file_size(path)};
}

std::vector<ExportFile> make_section(const SectionQuery& query, const SampleView& view,
                                     const fs::path& folder, const ExportBounds& bounds) {
  const reconstruct::OpenedSample& sample = view.sample;
  const reconstruct::Volume& volume = sample.volume;
  reconstruct::SectionRequest request = section_request(query, volume.cuboid());
  request.style.max_bytes = bounds.max_bytes;
  const int columns = outline_section(volume.cuboid(), volume.bits(), request).grid.columns;
  reconstruct::Section section;
  {
    // The chunks are gone before the picture is encoded, which needs the memory.
    VolumeBricks bricks(
        volume,
        std::min(bounds.cache_bytes, reconstruct::cache_for_one_section(columns, volume.bits())),
        {}, &sample.tail);
    section = cut_section(bricks, request, [&](std::int64_t done, std::int64_t total) {
      bounds.look_up();
      bounds.progress(done, total);
    });
  }
  const reconstruct::SectionRecord record{sample.folder.description().name,
                                          volume.cuboid(),
                                          request.plane,
                                          section.outline,
                                          section.image.size(),
                                          {0, 0},
                                          section.statistics.levels,
                                          section_command_parameters(query)};
  const fs::path file = folder / ("section" + extension_of(format_of(query.format)));
  write_section_image(file, section.image, picture_notes(record),
                      reconstruct::parse_quality("quality", query.quality));
  return {file_of(file)};
}

std::vector<ExportFile> make_series(const ExportOrder& order, const SampleView& view,
                                    const fs::path& folder, const ExportBounds& bounds) {
  const reconstruct::OpenedSample& sample = view.sample;
  const reconstruct::Cuboid& cuboid = sample.volume.cuboid();
  const SeriesQuery& query = *order.series;
  const reconstruct::PictureFormat format = format_of(query.style.format);
  const int quality = reconstruct::parse_quality("quality", query.style.quality);
  const nlohmann::ordered_json parameters = series_command_parameters(query);
  reconstruct::SectionStyle style = style_of(query, cuboid);
  style.max_bytes = bounds.max_bytes;
  VolumeBricks bricks(sample.volume, bounds.cache_bytes, {}, &sample.tail);
  const reconstruct::SeriesFrames frames(bricks, series_of(query, cuboid), style);

  const fs::path archive_path = folder / "series.zip";
  const fs::path film_path = folder / "series.mp4";
  std::optional<FrameArchive> archive;
  std::optional<reconstruct::Film> film;
  if (order.frames) archive.emplace(archive_path);
  if (order.movie) film.emplace(film_path, order.rate, frames.frame_size());
  const auto total = static_cast<std::int64_t>(frames.count());
  for (std::size_t i = 0; i < frames.count(); ++i) {
    bounds.look_up();
    const reconstruct::SampledImage drawn =
        frames.draw(i, [&](std::int64_t, std::int64_t) { bounds.look_up(); });
    if (archive) {
      const auto notes = frame_notes(frames, i, sample.folder.description().name, cuboid,
                                     drawn.statistics, parameters);
      archive->add(frame_file_name(frames.series(), i, extension_of(format)),
                   encode_section_image(drawn.image, format, notes, quality));
    }
    if (film) film->add(drawn.image);
    bounds.progress(static_cast<std::int64_t>(i) + 1, total);
  }
  std::vector<ExportFile> files;
  if (archive) {
    archive->finish();
    files.push_back(file_of(archive_path));
  }
  if (film) {
    film->finish();
    files.push_back(file_of(film_path));
  }
  return files;
}

}  // namespace

std::vector<ExportFile> make_export(const ExportOrder& order, const SampleView& view,
                                    const fs::path& folder, const ExportBounds& bounds) {
  return order.section ? make_section(*order.section, view, folder, bounds)
                       : make_series(order, view, folder, bounds);
}

}  // namespace biotomy::acquisition
