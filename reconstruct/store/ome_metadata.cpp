#include "reconstruct/store/ome_metadata.hpp"

#include <array>
#include <cmath>

#include <nlohmann/json.hpp>

#include "reconstruct/errors.hpp"

namespace biotomy::reconstruct {
namespace {

using nlohmann::json;

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

json dataset(const Vector3& spacing, int level) {
  const double factor = std::ldexp(1.0, level);
  json transformations =
      json::array({{{"type", "scale"},
                    {"scale", {1.0, factor * spacing.z, factor * spacing.y, factor * spacing.x}}}});
  if (level > 0) {
    const double offset = level_offset(level);
    transformations.push_back(
        {{"type", "translation"},
         {"translation", {0.0, offset * spacing.z, offset * spacing.y, offset * spacing.x}}});
  }
  return {{"path", level_path(level)}, {"coordinateTransformations", transformations}};
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

VolumeMetadata from_json(const json& group) {
  const json& attributes = group.at("attributes");
  const json& ome = attributes.at("ome");
  const json& own = attributes.at("biotomy");
  if (group.at("zarr_format") != 3 || ome.at("version") != "0.5") {
    throw SampleError("expected OME-Zarr 0.5");
  }
  const json& multiscale = ome.at("multiscales").at(0);
  const json& scale =
      multiscale.at("datasets").at(0).at("coordinateTransformations").at(0).at("scale");
  VolumeMetadata metadata;
  metadata.name = multiscale.at("name").get<std::string>();
  metadata.spacing = {scale.at(3).get<double>(), scale.at(2).get<double>(),
                      scale.at(1).get<double>()};
  metadata.levels = static_cast<int>(multiscale.at("datasets").size());
  metadata.bits = own.at("bits").get<int>();
  metadata.layers_present = own.at("layers_present").get<std::int64_t>();
  if (!(metadata.spacing.x > 0 && metadata.spacing.y > 0 && metadata.spacing.z > 0)) {
    throw SampleError("the spacings must be above 0");
  }
  if (metadata.layers_present < 0 || (metadata.bits != 8 && metadata.bits != 16)) {
    throw SampleError("attributes.biotomy makes no sense");
  }
  return metadata;
}

}  // namespace

std::string level_path(int level) {
  return std::to_string(level);
}

double level_offset(int level) {
  return (std::ldexp(1.0, level) - 1.0) / 2.0;
}

std::string group_metadata(const VolumeMetadata& metadata) {
  json datasets = json::array();
  for (int level = 0; level < metadata.levels; ++level) {
    datasets.push_back(dataset(metadata.spacing, level));
  }
  const json multiscale = {{"name", metadata.name},
                           {"axes", axes()},
                           {"datasets", datasets},
                           {"type", "mean"},  // how a level is made of the one before
                           {"metadata", {{"software", "Biotomy " BIOTOMY_VERSION}}}};
  const json ome = {{"version", "0.5"},
                    {"multiscales", json::array({multiscale})},
                    {"omero", {{"channels", channels(metadata.bits)}}}};
  const json own = {{"layers_present", metadata.layers_present}, {"bits", metadata.bits}};
  const json group = {
      {"zarr_format", 3}, {"node_type", "group"}, {"attributes", {{"ome", ome}, {"biotomy", own}}}};
  return group.dump(2) + "\n";
}

VolumeMetadata parse_group_metadata(const std::string& text, const std::string& name) {
  try {
    return from_json(json::parse(text));
  } catch (const json::exception& error) {
    throw SampleError(name + ": is not the metadata of a volume: " + error.what());
  } catch (const SampleError& error) {
    throw SampleError(name + ": cannot be read as a volume: " + error.what());
  }
}

}  // namespace biotomy::reconstruct
