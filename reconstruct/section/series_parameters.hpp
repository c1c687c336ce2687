#pragma once

#include <optional>
#include <string>

#include <nlohmann/json.hpp>

#include "reconstruct/picture/picture_notes.hpp"
#include "reconstruct/section/parameter_text.hpp"
#include "reconstruct/section/series.hpp"
#include "reconstruct/section/series_frames.hpp"

namespace biotomy::reconstruct {

/// How a series is asked for, as people write it; what was not given is none.
struct SeriesParameters {
  std::string axis = "";  ///< of a rotation: x, y, z or a direction a,b,c
  std::optional<std::string> normal = {};
  std::optional<std::string> through = {};
  std::optional<std::string> from = {};
  std::optional<std::string> to = {};
  std::string step = "";
};

/// `prefix` goes before the names in messages: "--" in the tool. Throw InvalidRequest that names
/// the parameter, and what rotation_series and translation_series throw.
Series parse_rotation(const std::string& prefix, const SeriesParameters& parameters,
                      LengthUnit unit, BasisKind basis, const Cuboid& cuboid);
Series parse_translation(const std::string& prefix, const SeriesParameters& parameters,
                         LengthUnit unit, BasisKind basis, const Cuboid& cuboid);

/// What the file of a frame says of it: `sample` is the sample's name, `parameters` are what was
/// asked for.
PictureNotes frame_notes(const SeriesFrames& frames, std::size_t index, const std::string& sample,
                         const Cuboid& cuboid, const SampleStatistics& statistics,
                         const nlohmann::ordered_json& parameters);

}  // namespace biotomy::reconstruct
