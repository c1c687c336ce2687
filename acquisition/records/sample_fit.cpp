#include "acquisition/records/sample_fit.hpp"

#include <cmath>
#include <filesystem>
#include <system_error>

namespace biotomy::acquisition {
namespace {

using reconstruct::SampleDescription;
using reconstruct::SampleFolder;

constexpr std::uint64_t kColours = 3;

std::string size_text(const SampleDescription& description) {
  const reconstruct::GridSize& size = description.cuboid.size;
  return std::to_string(size.x) + " × " + std::to_string(size.y) + " × " + std::to_string(size.z) +
         " voxels of " + std::to_string(description.bits) + " bits";
}

bool same_spacing(const reconstruct::Vector3& a, const reconstruct::Vector3& b) {
  constexpr double kTolerance = 1e-6;
  return std::abs(a.x - b.x) < kTolerance && std::abs(a.y - b.y) < kTolerance &&
         std::abs(a.z - b.z) < kTolerance;
}

}  // namespace

SampleDescription description_of(const JobPlan& plan, const bridge::CameraDescription& camera,
                                 const std::string& created) {
  return {
      .name = plan.name,
      .cuboid = {.size = {camera.width, camera.height, plan.layers},
                 .spacing = {plan.pixel_x.value, plan.pixel_y.value, plan.layer_thickness.value}},
      .bits = plan.bits,
      .notes = plan.notes,
      .created = created};
}

std::optional<std::string> sample_complaint(const SampleFolder& sample, const JobPlan& plan,
                                            const bridge::CameraDescription& camera) {
  const SampleDescription wanted = description_of(plan, camera, "");
  const SampleDescription& found = sample.description();
  const std::string the_sample = "the sample " + plan.sample.string();
  if (found.cuboid.size != wanted.cuboid.size || found.bits != wanted.bits) {
    return the_sample + " is " + size_text(found) + " and the job would make " + size_text(wanted) +
           ": name another sample or mend the configuration";
  }
  if (!same_spacing(found.cuboid.spacing, wanted.cuboid.spacing)) {
    return the_sample +
           " has another spacing than pixel_um and layer_thickness_um say: name another "
           "sample or mend the configuration";
  }
  if (found.name != wanted.name) {
    return the_sample + " is named \"" + found.name + "\" and the job \"" + wanted.name +
           "\": name another sample or mend the configuration";
  }
  return std::nullopt;
}

std::optional<std::string> committed_files_complaint(const SampleFolder& sample,
                                                     const JournalReader& journal) {
  for (const LayerRow& layer : journal.committed_layers(1, sample.description().cuboid.size.z)) {
    const std::filesystem::path file = sample.path() / layer.file;
    std::error_code error;
    const std::uintmax_t bytes = std::filesystem::file_size(file, error);
    if (error) {
      return "layer " + std::to_string(layer.layer) + " is committed in the journal but its file " +
             file.string() + " is missing: find it before going on";
    }
    if (bytes != layer.bytes) {
      return file.string() + " has " + std::to_string(bytes) + " bytes and the journal committed " +
             std::to_string(layer.bytes) + ": it was changed since";
    }
  }
  return std::nullopt;
}

bool holds_constants(const JournalSummary& journal) {
  return journal.last_committed > 0 && !journal.constants.empty();
}

std::optional<std::string> constants_complaint(const JournalSummary& journal,
                                               const std::vector<Constant>& constants) {
  if (!holds_constants(journal)) return std::nullopt;
  for (const Constant& now : constants) {
    for (const Constant& then : journal.constants) {
      if (then.name != now.name || then.value == now.value) continue;
      return "layers 1 to " + std::to_string(journal.last_committed) + " were photographed with " +
             then.name + " = " + then.value + ", and the next would be with " + now.value +
             ": restore it, or name another sample";
    }
  }
  return std::nullopt;
}

std::uint64_t bytes_of_a_layer(const JobPlan& plan, const bridge::CameraDescription& camera) {
  return 2 * static_cast<std::uint64_t>(camera.width) * static_cast<std::uint64_t>(camera.height) *
         kColours * static_cast<std::uint64_t>(plan.bits / 8);
}

}  // namespace biotomy::acquisition
