#include "reconstruct/store/ome_metadata.hpp"

#include <array>
#include <cmath>

#include <nlohmann/json.hpp>

#include "reconstruct/errors.hpp"
#include "reconstruct/geometry/spacing.hpp"
#include "reconstruct/store/metadata_json.hpp"

namespace biotomy::reconstruct {
namespace {

using nlohmann::json;

constexpr std::size_t kMostLevels = 32;
constexpr std::int64_t kMostLayers = 1'000'000;  // as in sample.toml
constexpr double kMostFactor = 1 << 30;
constexpr double kSameFactor = 1e-9;  // relative

struct Colour {
  const char* label;
  const char* hexadecimal;
};
constexpr std::array kColours{Colour{"red", "FF0000"}, Colour{"green", "00FF00"},
                              Colour{"blue", "0000FF"}};

json axes() {
  json list = json::array({{{"name", "c"}, {"type", "channel"}}});
  for (const char* name : {"z", "y", "x"}) {
    list.push_back({{"name", name}, {"type", "space"}, {"unit", "micrometer"}});
  }
  return list;
}

// Each voxel is the mean of those it stands for, so its centre lies (factor − 1)/2 voxels of level
// 0 further in; viewers that are not told so show the levels shifted against each other.
json dataset(const Vector3& spacing, std::size_t level, const LevelFactor& factor) {
  const PyramidLevel place = pyramid_level({{1, 1, 1}, spacing}, factor);
  const Vector3& scale = place.spacing;
  const Vector3& origin = place.origin;
  json transformations =
      json::array({{{"type", "scale"}, {"scale", {1.0, scale.z, scale.y, scale.x}}}});
  if (level > 0) {
    transformations.push_back(
        {{"type", "translation"}, {"translation", {0.0, origin.z, origin.y, origin.x}}});
  }
  return {{"path", level_path(static_cast<int>(level))},
          {"coordinateTransformations", transformations}};
}

json channels(int bits) {
  const int highest = (1 << bits) - 1;
  json list = json::array();
  for (const Colour& colour : kColours) {
    list.push_back({{"label", colour.label},
                    {"color", colour.hexadecimal},
                    {"active", true},
                    {"window", {{"min", 0}, {"max", highest}, {"start", 0}, {"end", highest}}}});
  }
  return list;
}

Vector3 scale_of(const json& dataset) {
  const json& scale = dataset.at("coordinateTransformations").at(0).at("scale");
  if (scale.size() != 4) {
    throw SampleError("a level's scale is not that of c, z, y, x");
  }
  const Vector3 spacing{scale.at(3).get<double>(), scale.at(2).get<double>(),
                        scale.at(1).get<double>()};
  for (const double each : {spacing.x, spacing.y, spacing.z}) {
    if (!is_spacing(each)) {
      throw SampleError("the spacings make no sense");
    }
  }
  return spacing;
}

/// How many voxels of level 0 a voxel of a level takes along one axis.
std::int64_t factor_between(double finest, double spacing) {
  const double factor = std::round(spacing / finest);
  int exponent = 0;
  if (!(std::abs(spacing / finest - factor) < kSameFactor * factor) || factor > kMostFactor ||
      std::frexp(factor, &exponent) != 0.5) {
    throw SampleError("a level's voxels are not 1, 2, 4 … times as large as level 0's");
  }
  return static_cast<std::int64_t>(factor);
}

/// Some axes, or all. A level is computed from the one before, by means of two.
bool halves_axes(const LevelFactor& level, const LevelFactor& before) {
  const auto is_same_or_twice = [](std::int64_t factor, std::int64_t finer) {
    return factor == finer || factor == 2 * finer;
  };
  return is_same_or_twice(level.x, before.x) && is_same_or_twice(level.y, before.y) &&
         is_same_or_twice(level.z, before.z) && level != before;
}

std::vector<LevelFactor> levels_of(const json& datasets) {
  if (datasets.empty() || datasets.size() > kMostLevels) {
    throw SampleError("it has " + std::to_string(datasets.size()) + " levels");
  }
  const Vector3 finest = scale_of(datasets.at(0));
  std::vector<LevelFactor> levels;
  for (std::size_t level = 0; level < datasets.size(); ++level) {
    if (datasets.at(level).at("path") != level_path(static_cast<int>(level))) {
      throw SampleError("its levels are not named by their numbers");
    }
    const Vector3 scale = scale_of(datasets.at(level));
    levels.push_back({factor_between(finest.x, scale.x), factor_between(finest.y, scale.y),
                      factor_between(finest.z, scale.z)});
    if (level > 0 && !halves_axes(levels[level], levels[level - 1])) {
      throw SampleError("a level does not halve axes of the one before");
    }
  }
  return levels;
}

VolumeMetadata from_json(const json& group) {
  const json& attributes = group.at("attributes");
  const json& ome = attributes.at("ome");
  const json& own = attributes.at("biotomy");
  if (group.at("zarr_format") != 3 || ome.at("version") != "0.5") {
    throw SampleError("expected OME-Zarr 0.5");
  }
  const json& multiscale = ome.at("multiscales").at(0);
  const json& datasets = multiscale.at("datasets");
  VolumeMetadata metadata;
  metadata.name = multiscale.at("name").get<std::string>();
  metadata.levels = levels_of(datasets);
  metadata.spacing = scale_of(datasets.at(0));
  metadata.bits = static_cast<int>(whole_number(own.at("bits"), "bits", 8, 16));
  metadata.layers_present =
      whole_number(own.at("layers_present"), "layers_present", 0, kMostLayers);
  metadata.every_shard = own.value("every_shard", false);
  if (metadata.bits != 8 && metadata.bits != 16) {
    throw SampleError("bits must be 8 or 16");
  }
  return metadata;
}

}  // namespace

std::int64_t layers_present_at(const VolumeMetadata& metadata, std::size_t level) {
  const std::int64_t factor = metadata.levels.at(level).z;
  return (metadata.layers_present + factor - 1) / factor;
}

std::string level_path(int level) {
  return std::to_string(level);
}

std::string group_metadata(const VolumeMetadata& metadata) {
  json datasets = json::array();
  for (std::size_t level = 0; level < metadata.levels.size(); ++level) {
    datasets.push_back(dataset(metadata.spacing, level, metadata.levels[level]));
  }
  const json multiscale = {{"name", metadata.name},
                           {"axes", axes()},
                           {"datasets", datasets},
                           {"type", "mean"},  // how a level is made of the one before
                           {"metadata", {{"software", "Biotomy " BIOTOMY_VERSION}}}};
  const json omero = {{"channels", channels(metadata.bits)}};
  const json ome = {
      {"version", "0.5"}, {"multiscales", json::array({multiscale})}, {"omero", omero}};
  json own = {{"layers_present", metadata.layers_present}, {"bits", metadata.bits}};
  if (metadata.every_shard) {
    own["every_shard"] = true;
  }
  // neuroglancer looks for omero where OME-Zarr 0.4 had it.
  const json attributes = {{"ome", ome}, {"omero", omero}, {"biotomy", own}};
  const json group = {{"zarr_format", 3}, {"node_type", "group"}, {"attributes", attributes}};
  return group.dump(2) + "\n";
}

VolumeMetadata parse_group_metadata(const std::string& text, const std::string& name) {
  try {
    return from_json(parse_metadata_json(text));
  } catch (const std::exception& error) {  // of ours, and json's for what is missing
    throw SampleError(name + ": is not the metadata of a volume: " + error.what());
  }
}

}  // namespace biotomy::reconstruct
