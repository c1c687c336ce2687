#include "reconstruct/store/zarr_array.hpp"

#include <array>

#include <nlohmann/json.hpp>

#include "reconstruct/errors.hpp"
#include "reconstruct/store/codecs.hpp"

namespace biotomy::reconstruct {
namespace {

using nlohmann::json;

constexpr int kColours = 3;
constexpr std::int64_t kMostVoxels = 1'000'000'000;  // along one axis; refuses nonsense

std::int64_t divide_up(std::int64_t size, std::int64_t block) {
  return (size + block - 1) / block;
}

json to_json(const ZarrArray& array) {
  const VolumeLayout& layout = array.layout;
  const json index_codecs = {{{"name", "bytes"}, {"configuration", {{"endian", "little"}}}},
                             {{"name", "crc32c"}}};
  const json sharding = {
      {"name", "sharding_indexed"},
      {"configuration",
       {{"chunk_shape", {kColours, layout.chunk[0], layout.chunk[1], layout.chunk[2]}},
        {"codecs", codec_chain(layout, array.bits)},
        {"index_codecs", index_codecs},
        {"index_location", "end"}}}};
  return {{"zarr_format", 3},
          {"node_type", "array"},
          {"shape", {kColours, array.size.z, array.size.y, array.size.x}},
          {"data_type", array.bits == 8 ? "uint8" : "uint16"},
          {"chunk_grid",
           {{"name", "regular"},
            {"configuration",
             {{"chunk_shape", {kColours, layout.shard[0], layout.shard[1], layout.shard[2]}}}}}},
          {"chunk_key_encoding", {{"name", "default"}, {"configuration", {{"separator", "/"}}}}},
          {"fill_value", 0},
          {"codecs", json::array({sharding})},
          {"dimension_names", {"c", "z", "y", "x"}},
          {"attributes", json::object()}};
}

/// The last three of four sizes, of which the first counts the colours.
template <typename Size>
std::array<Size, 3> sizes_zyx(const json& shape) {
  if (shape.size() != 4 || shape.at(0) != kColours) {
    throw SampleError("its shape is not colour, z, y, x");
  }
  return {shape.at(1).get<Size>(), shape.at(2).get<Size>(), shape.at(3).get<Size>()};
}

ZarrArray from_json(const json& metadata) {
  ZarrArray array;
  const auto size = sizes_zyx<std::int64_t>(metadata.at("shape"));
  array.size = {size[2], size[1], size[0]};
  for (const std::int64_t count : size) {
    if (count < 1 || count > kMostVoxels) {
      throw SampleError("its shape makes no sense");
    }
  }
  array.bits = metadata.at("data_type") == "uint16" ? 16 : 8;
  array.layout.shard =
      sizes_zyx<int>(metadata.at("chunk_grid").at("configuration").at("chunk_shape"));
  const json& codecs = metadata.at("codecs");
  if (codecs.size() != 1 || codecs.at(0).at("name") != "sharding_indexed") {
    throw SampleError("it is not sharded");
  }
  const json& sharding = codecs.at(0).at("configuration");
  array.layout.chunk = sizes_zyx<int>(sharding.at("chunk_shape"));

  // What the fields above do not tell apart is told by comparing with what we would have written.
  for (const bool interleaved : {true, false}) {
    for (const std::string& name : codec_names()) {
      array.layout.interleaved = interleaved;
      array.layout.codec = name;
      if (codec_chain(array.layout, array.bits) == sharding.at("codecs")) {
        check_layout(array.layout);
        json expected = to_json(array);
        expected["attributes"] = metadata.value("attributes", json::object());
        if (expected != metadata) {
          throw SampleError("it is not an array as Biotomy writes them");
        }
        return array;
      }
    }
  }
  throw SampleError("its codecs are not known: " + sharding.at("codecs").dump());
}

}  // namespace

BlockCount shards_of(const ZarrArray& array) {
  return {divide_up(array.size.z, array.layout.shard[0]),
          divide_up(array.size.y, array.layout.shard[1]),
          divide_up(array.size.x, array.layout.shard[2])};
}

BlockCount chunks_of_shard(const VolumeLayout& layout) {
  return {layout.shard[0] / layout.chunk[0], layout.shard[1] / layout.chunk[1],
          layout.shard[2] / layout.chunk[2]};
}

std::string array_metadata(const ZarrArray& array) {
  return to_json(array).dump(2) + "\n";
}

ZarrArray parse_array_metadata(const std::string& text, const std::string& name) {
  try {
    return from_json(json::parse(text));
  } catch (const json::exception& error) {
    throw SampleError(name + ": is not the metadata of a volume: " + error.what());
  } catch (const std::exception& error) {
    throw SampleError(name + ": cannot be read as a volume: " + error.what());
  }
}

std::string shard_key(std::int64_t z, std::int64_t y, std::int64_t x) {
  return "c/0/" + std::to_string(z) + "/" + std::to_string(y) + "/" + std::to_string(x);
}

}  // namespace biotomy::reconstruct
