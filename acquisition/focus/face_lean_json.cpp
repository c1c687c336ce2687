#include "acquisition/focus/face_lean_json.hpp"

#include <nlohmann/json.hpp>

namespace biotomy::acquisition {

nlohmann::ordered_json lean_json(const std::optional<FaceLean>& lean) {
  if (!lean) return nullptr;
  return {{"across_um", lean->across.value},
          {"down_um", lean->down.value},
          {"angle_degrees", lean->angle_degrees},
          {"tiles", lean->tiles}};
}

}  // namespace biotomy::acquisition
