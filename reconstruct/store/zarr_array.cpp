#include "reconstruct/store/zarr_array.hpp"

#include <array>
#include <cstddef>
#include <utility>

#include <nlohmann/json.hpp>

#include "reconstruct/errors.hpp"
#include "reconstruct/excerpt.hpp"
#include "reconstruct/store/codecs.hpp"
#include "reconstruct/store/metadata_json.hpp"

namespace biotomy::reconstruct {
namespace {

using nlohmann::json;

constexpr int kColours = 3;
// Along one axis, as in sample.toml; the product of three and the bytes of a voxel fit 63 bits.
constexpr std::int64_t kMostVoxels = 1'000'000;

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
std::array<Size, 3> sizes_zyx(const json& shape, const std::string& what) {
  if (!shape.is_array() || shape.size() != 4 || shape.at(0) != kColours) {
    throw SampleError(what + " is not colour, z, y, x");
  }
  std::array<Size, 3> sizes{};
  for (std::size_t axis = 0; axis < sizes.size(); ++axis) {
    sizes[axis] = static_cast<Size>(whole_number(shape.at(axis + 1), what, 1, kMostVoxels));
  }
  return sizes;
}

/// The same codecs with the order of a value's bytes, which one byte has not and some writers then
/// leave out.
json with_endian(json codecs) {
  for (json& codec : codecs) {
    if (codec.is_object() && codec.value("name", json()) == "bytes" &&
        codec.value("configuration", json::object()).empty()) {
      codec["configuration"] = {{"endian", "little"}};
    }
  }
  return codecs;
}

/// The size of Blosc's blocks is a matter of the encoder: each buffer says its own.
json without_block_size(json codecs) {
  for (json& codec : codecs) {
    if (codec.is_object() && codec.value("name", json()) == "blosc" &&
        codec.value("configuration", json()).is_object()) {
      codec["configuration"].erase("blocksize");
    }
  }
  return codecs;
}

json& codecs_of_a_chunk(json& metadata) {
  return metadata.at("codecs").at(0).at("configuration").at("codecs");
}

/// What tells arrays apart to a reader.
json as_read(json metadata) {
  json& codecs = codecs_of_a_chunk(metadata);
  codecs = without_block_size(std::move(codecs));
  return metadata;
}

/// The same array as we write it: without what other programs leave in metadata that they have
/// rewritten, to which nothing of what we read would be different.
json without_harmless_additions(json metadata, int bits) {
  metadata["attributes"] = json::object();
  const auto transformers = metadata.find("storage_transformers");
  if (transformers != metadata.end() && *transformers == json::array()) {
    metadata.erase(transformers);
  }
  if (bits == 8) {
    json& codecs = codecs_of_a_chunk(metadata);
    codecs = with_endian(std::move(codecs));
  }
  return as_read(std::move(metadata));
}

ZarrArray from_json(const json& found) {
  ZarrArray array;
  const auto size = sizes_zyx<std::int64_t>(found.at("shape"), "its shape");
  array.size = {size[2], size[1], size[0]};
  array.bits = found.at("data_type") == "uint16" ? 16 : 8;
  array.layout.shard = sizes_zyx<int>(found.at("chunk_grid").at("configuration").at("chunk_shape"),
                                      "the shape of its shards");
  const json& codecs = found.at("codecs");
  if (codecs.size() != 1 || codecs.at(0).at("name") != "sharding_indexed") {
    throw SampleError("it is not sharded");
  }
  const json metadata = without_harmless_additions(found, array.bits);
  const json& sharding = metadata.at("codecs").at(0).at("configuration");
  array.layout.chunk = sizes_zyx<int>(sharding.at("chunk_shape"), "the shape of its chunks");

  // What the fields above do not tell apart is told by comparing with what we would have written.
  for (const bool interleaved : {true, false}) {
    for (const std::string& name : codec_names()) {
      array.layout.interleaved = interleaved;
      array.layout.codec = name;
      if (without_block_size(codec_chain(array.layout, array.bits)) == sharding.at("codecs")) {
        check_layout(array.layout);
        if (as_read(to_json(array)) != metadata) {
          throw SampleError("it is not an array as Biotomy writes them");
        }
        return array;
      }
    }
  }
  throw SampleError("its codecs are not known: " + excerpt(sharding.at("codecs").dump()));
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
    return from_json(parse_metadata_json(text));
  } catch (const std::exception& error) {  // of ours, and json's for what is missing
    throw SampleError(name + ": is not the metadata of a volume: " + error.what());
  }
}

std::string shard_key(std::int64_t z, std::int64_t y, std::int64_t x) {
  return "c/0/" + std::to_string(z) + "/" + std::to_string(y) + "/" + std::to_string(x);
}

}  // namespace biotomy::reconstruct
