#include "acquisition/viewer/sample_json.hpp"

#include <nlohmann/json.hpp>

#include "reconstruct/section/section_record.hpp"

namespace biotomy::acquisition {
namespace {

using nlohmann::ordered_json;

ordered_json levels_json(const reconstruct::Volume& volume) {
  ordered_json levels = ordered_json::array();
  for (int number = 0; number < volume.levels(); ++number) {
    const auto& [factor, size, spacing, origin] = volume.level(number);
    levels.push_back({{"size", {size.x, size.y, size.z}},
                      {"spacing_um", {spacing.x, spacing.y, spacing.z}},
                      {"origin_um", {origin.x, origin.y, origin.z}},
                      {"factor", {factor.x, factor.y, factor.z}}});
  }
  return levels;
}

}  // namespace

std::string sample_json(const SampleView& view, std::int64_t committed) {
  const reconstruct::SampleDescription& description = view.sample.folder.description();
  const auto& [size, spacing] = description.cuboid;
  return reconstruct::json_text({{"name", description.name},
                                 {"notes", description.notes},
                                 {"created", description.created},
                                 {"size", {size.x, size.y, size.z}},
                                 {"spacing_um", {spacing.x, spacing.y, spacing.z}},
                                 {"bits", description.bits},
                                 {"layers_planned", size.z},
                                 {"committed", committed},
                                 {"layers_present", view.sample.tail.layers_present()},
                                 {"layers_in_volume", view.sample.volume.layers_present()},
                                 {"levels", levels_json(view.sample.volume)},
                                 {"generation", view.generation},
                                 {"volume_url", "/volume.ome.zarr"},
                                 {"background", "0,0,0"}});
}

}  // namespace biotomy::acquisition
