#include "reconstruct/section/recorded_plane.hpp"

#include <array>
#include <optional>
#include <string>

#include <nlohmann/json.hpp>

#include "reconstruct/errors.hpp"
#include "reconstruct/picture/picture_description.hpp"
#include "reconstruct/store/metadata_json.hpp"
#include "reconstruct/store/metadata_text.hpp"

namespace biotomy::reconstruct {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr const char* kExpected =
    ": does not say along which plane it was cut; give the .json, .png or .tif of a section";

bool is_sidecar(const fs::path& file) {
  return file.extension() == ".json";
}

std::optional<std::string> record_text(const fs::path& file) {
  std::error_code error;
  if (!fs::exists(file, error)) {
    throw SampleError(file.string() + ": there is no such file: check its name");
  }
  return is_sidecar(file) ? read_metadata_file(file) : picture_description(file);
}

/// Throws json::exception and InvalidRequest.
Plane plane_in(const json& record) {
  const json& plane = record.at("plane");
  const auto normal = plane.at("normal").get<std::array<double, 3>>();
  return Plane::from_equation(normal[0], normal[1], normal[2], plane.at("offset_um").get<double>());
}

}  // namespace

Plane recorded_plane(const fs::path& file) {
  const std::optional<std::string> text = record_text(file);
  if (!text) {
    throw SampleError(file.string() + kExpected);
  }
  json record;
  try {
    record = parse_metadata_json(*text);
  } catch (const SampleError& error) {
    // A picture may say anything of itself.
    throw SampleError(file.string() +
                      (is_sidecar(file) ? ": " + std::string(error.what()) : kExpected));
  }
  try {
    return plane_in(record);
  } catch (const json::exception&) {
    throw SampleError(file.string() + kExpected);
  } catch (const InvalidRequest&) {
    throw SampleError(file.string() + kExpected);
  }
}

}  // namespace biotomy::reconstruct
