#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include <nlohmann/json.hpp>

#include "acquisition/viewer/section_query.hpp"
#include "reconstruct/section/series_parameters.hpp"

namespace biotomy::acquisition {

/// What /series/… is asked for: the parameters of `biotomy series` under their names.
struct SeriesQuery {
  std::string kind;  ///< "rotate" or "translate"
  reconstruct::SeriesParameters series;
  SectionQuery style;  ///< without a plane
};

/// `others` are parameters that are known beside. Throws InvalidRequest.
SeriesQuery series_query(const Query& query, std::initializer_list<std::string_view> others = {});

/// As `biotomy series` understands it. Throws InvalidRequest; Refusal where it has more than ten
/// thousand frames.
reconstruct::Series series_of(const SeriesQuery& query, const reconstruct::Cuboid& cuboid);

/// Throws InvalidRequest.
reconstruct::SectionStyle style_of(const SeriesQuery& query, const reconstruct::Cuboid& cuboid);

/// The command line that makes the frames, and the film, without regard to `fit`, ready for a
/// shell.
std::string series_command(const SeriesQuery& query, const std::filesystem::path& sample,
                           bool movie = false, const std::string& rate = {});

/// What that command says of itself in the pictures that it writes.
nlohmann::ordered_json series_command_parameters(const SeriesQuery& query);

}  // namespace biotomy::acquisition
