#include <array>
#include <cstddef>
#include <cstdint>
#include <iomanip>
#include <iostream>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "reconstruct/sample/sample_folder.hpp"
#include "reconstruct/store/sample_summary.hpp"
#include "tools/command.hpp"

namespace biotomy::tools {
namespace {

using reconstruct::SampleDescription;
using reconstruct::SampleFolder;
using reconstruct::SampleSummary;

constexpr double kStep = 1024.0;  // from one unit of size to the next

struct Options {
  std::string sample;
  bool json = false;
};

nlohmann::json to_json(const SampleDescription& description, const SampleSummary& summary) {
  const auto& [size, spacing] = description.cuboid;
  const auto& layout = summary.layout;
  nlohmann::json volume;  // null without one
  if (summary.has_volume) {
    nlohmann::json levels = nlohmann::json::array();
    for (const auto& level : summary.levels) {
      levels.push_back({{"size", {level.size.x, level.size.y, level.size.z}},
                        {"spacing_um", {level.spacing.x, level.spacing.y, level.spacing.z}},
                        {"origin_um", {level.origin.x, level.origin.y, level.origin.z}}});
    }
    volume = {{"layers", summary.layers_in_volume},
              {"bytes", summary.volume_bytes},
              {"chunk", {layout.chunk[2], layout.chunk[1], layout.chunk[0]}},
              {"shard", {layout.shard[2], layout.shard[1], layout.shard[0]}},
              {"codec", layout.codec},
              {"interleaved", layout.interleaved},
              {"levels", levels}};
  }
  return {{"name", description.name},
          {"created", description.created},
          {"notes", description.notes},
          {"size", {size.x, size.y, size.z}},
          {"spacing_um", {spacing.x, spacing.y, spacing.z}},
          {"bits", description.bits},
          {"repeated_layers", description.repeated_layers},
          {"layer_images", {{"count", summary.layer_images}, {"bytes", summary.layer_bytes}}},
          {"volume", volume},
          {"sections", {{"layers", summary.layers_in_sections}}}};
}

std::string size_text(std::uint64_t bytes) {
  constexpr std::array<const char*, 4> kUnits{"KiB", "MiB", "GiB", "TiB"};
  auto amount = static_cast<double>(bytes);
  if (amount < kStep) return std::to_string(bytes) + " bytes";
  amount /= kStep;
  std::size_t unit = 0;
  while (amount >= kStep && unit + 1 < kUnits.size()) {
    amount /= kStep;
    ++unit;
  }
  std::ostringstream text;
  text << std::fixed << std::setprecision(1) << amount << ' ' << kUnits[unit];
  return text.str();
}

/// 4, 7-9
std::string numbers_text(const std::vector<std::int64_t>& numbers) {
  std::string text;
  for (std::size_t first = 0; first < numbers.size();) {
    std::size_t last = first;
    while (last + 1 < numbers.size() && numbers[last + 1] == numbers[last] + 1) {
      ++last;
    }
    text += (text.empty() ? "" : ", ") + std::to_string(numbers[first]);
    if (last > first) {
      text += '-' + std::to_string(numbers[last]);
    }
    first = last + 1;
  }
  return text;
}

void print(const SampleDescription& description, const SampleSummary& summary) {
  const auto& [size, spacing] = description.cuboid;
  const auto extent = description.cuboid.extent();
  const auto& layout = summary.layout;
  std::cout << "name      " << description.name << '\n'
            << "created   " << description.created << '\n';
  if (!description.notes.empty()) {
    std::cout << "notes     " << description.notes << '\n';
  }
  std::cout << "voxels    " << size.x << " × " << size.y << " × " << size.z << ", "
            << description.bits << " bits a colour\n"
            << "spacing   " << spacing.x << " × " << spacing.y << " × " << spacing.z << " µm\n"
            << "extent    " << extent.x / 1000 << " × " << extent.y / 1000 << " × "
            << extent.z / 1000 << " mm between the outermost voxels' centres\n"
            << "layers    " << summary.layer_images << " of " << size.z << ", "
            << size_text(summary.layer_bytes) << '\n'
            << "sections  reach layer " << summary.layers_in_sections << '\n';
  if (!description.repeated_layers.empty()) {
    std::cout << "gaps      without a photograph, the layer before once more: "
              << numbers_text(description.repeated_layers) << '\n';
  }
  if (!summary.has_volume) {
    std::cout << "volume    none yet\n";
    return;
  }
  std::cout << "volume    " << summary.layers_in_volume << " layers, "
            << size_text(summary.volume_bytes) << "; chunks of " << layout.chunk[2] << " × "
            << layout.chunk[1] << " × " << layout.chunk[0] << ", shards of " << layout.shard[2]
            << " × " << layout.shard[1] << " × " << layout.shard[0] << ", " << layout.codec << ", "
            << (layout.interleaved ? "interleaved" : "planar") << '\n';
  for (std::size_t i = 0; i < summary.levels.size(); ++i) {
    const auto& level = summary.levels[i];
    std::cout << "  level " << i << "  " << level.size.x << " × " << level.size.y << " × "
              << level.size.z << " voxels of " << level.spacing.x << " × " << level.spacing.y
              << " × " << level.spacing.z << " µm\n";
  }
}

void run(const Options& options) {
  const SampleFolder sample = SampleFolder::open(options.sample);
  const SampleSummary summary = summarise(sample);
  if (options.json) {
    std::cout << to_json(sample.description(), summary).dump(2) << '\n';
  } else {
    print(sample.description(), summary);
  }
  if (summary.volume_misfit) {
    std::cerr << "biotomy: " << sample.volume_path().string() << ": " << *summary.volume_misfit
              << '\n';
  }
}

}  // namespace

void add_info_command(CLI::App& app) {
  auto options = std::make_shared<Options>();
  CLI::App* command = app.add_subcommand("info", "Tells what a sample is and what there is of it.");
  command->add_option("SAMPLE", options->sample, "The sample folder")->required();
  command->add_flag("--json", options->json, "As JSON");
  command->callback([options] { run(*options); });
}

}  // namespace biotomy::tools
