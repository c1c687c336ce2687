#include "reconstruct/import/import_request.hpp"

#include <array>
#include <cstdint>

#include <nlohmann/json.hpp>
#include <sys/stat.h>

#include "reconstruct/errors.hpp"
#include "reconstruct/utf8.hpp"

namespace biotomy::reconstruct {
namespace {

namespace fs = std::filesystem;

using nlohmann::json;

json image_record(const fs::path& path) {
  struct stat status {};
  if (::stat(path.c_str(), &status) != 0) {
    throw SampleError(path.string() + ": is gone");
  }
  return {{"path", utf8_text(fs::absolute(path).lexically_normal().string())},
          {"bytes", static_cast<std::int64_t>(status.st_size)},
          {"changed",
           std::to_string(status.st_mtim.tv_sec) + "." + std::to_string(status.st_mtim.tv_nsec)}};
}

json scale_record(const std::variant<VoxelSpacing, StackSize>& scale) {
  const auto* spacing = std::get_if<VoxelSpacing>(&scale);
  const Vector3& um = spacing != nullptr ? spacing->um : std::get<StackSize>(scale).um;
  return {{"of", spacing != nullptr ? "voxel" : "stack"}, {"um", {um.x, um.y, um.z}}};
}

/// A record's key and what it is called in a message.
struct Named {
  const char* key;
  const char* name;
};
constexpr std::array kOptions{
    Named{"scale", "the spacing or size"}, Named{"name", "the name"}, Named{"notes", "the notes"},
    Named{"layers", "the compression of the layers"}, Named{"volume", "the layout of the volume"}};

}  // namespace

json import_record(const ImageSequence& images, const ImportRequest& request) {
  json files = json::array();
  for (const fs::path& file : images.files()) {
    files.push_back(image_record(file));
  }
  const LayerFormat& layers = request.layer_format;
  const VolumeLayout& layout = request.layout;
  return {{"images", files},
          {"scale", scale_record(request.scale)},
          {"name", request.name},
          {"notes", request.notes},
          {"layers",
           {{"compression", layers.compression == LayerCompression::zstd ? "zstd" : "deflate"},
            {"level", layers.level}}},
          {"volume",
           {{"chunk_zyx", layout.chunk},
            {"shard_zyx", layout.shard},
            {"codec", layout.codec},
            {"interleaved", layout.interleaved}}}};
}

std::optional<std::string> import_difference(
    const json& begun, const json& asked,
    const std::function<bool(std::int64_t layer)>& is_stored) {
  for (const Named& option : kOptions) {
    if (begun.value(option.key, json()) != asked.at(option.key)) {
      return option.name;
    }
  }
  const json images = begun.value("images", json::array());
  const json& now = asked.at("images");
  if (images.size() != now.size()) {
    return "the number of images";
  }
  for (std::size_t i = 0; i < now.size(); ++i) {
    const bool is_same = is_stored(static_cast<std::int64_t>(i) + 1)
                             ? images[i] == now[i]
                             : images[i].value("path", "") == now[i].at("path").get<std::string>();
    if (!is_same) {
      return "the image " + now[i].at("path").get<std::string>();
    }
  }
  return std::nullopt;
}

}  // namespace biotomy::reconstruct
