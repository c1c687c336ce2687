#pragma once

#include <optional>

#include <nlohmann/json_fwd.hpp>

#include "acquisition/focus/face_lean.hpp"

namespace biotomy::acquisition {

/// As journal, status and calibration give it: {across_um, down_um, angle_degrees, tiles}, or null.
nlohmann::ordered_json lean_json(const std::optional<FaceLean>& lean);

}  // namespace biotomy::acquisition
