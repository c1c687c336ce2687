#include "reconstruct/sample/sample_folder.hpp"

#include <array>
#include <cstdio>
#include <fstream>
#include <initializer_list>
#include <optional>
#include <sstream>
#include <string_view>
#include <utility>

#include <toml++/toml.h>

#include "reconstruct/disk/durable_file.hpp"
#include "reconstruct/errors.hpp"
#include "reconstruct/excerpt.hpp"
#include "reconstruct/geometry/spacing.hpp"

namespace biotomy::reconstruct {
namespace {

namespace fs = std::filesystem;

constexpr const char* kLayersName = "layers";
constexpr const char* kRejectedName = "rejected";
constexpr std::int64_t kMostVoxels = 1'000'000;  // along one axis
constexpr std::uintmax_t kMostDescriptionBytes = std::uintmax_t{1} << 20;
constexpr const char* kRepeatedLayers = "repeated_layers";
constexpr std::size_t kMostRepeated = 100'000;  // so that the description can be read again

[[noreturn]] void fail(const fs::path& file, const std::string& what) {
  throw SampleError(file.string() + ": " + what);
}

void check(const SampleDescription& description, const fs::path& file) {
  const auto check_count = [&](const char* key, std::int64_t count) {
    if (count < 1 || count > kMostVoxels) {
      fail(file, std::string("grid.") + key + " is " + std::to_string(count) + ", must be 1 to " +
                     std::to_string(kMostVoxels));
    }
  };
  const auto check_spacing = [&](const char* key, double spacing) {
    if (!is_spacing(spacing)) {
      fail(file, std::string("spacing_um.") + key + " must be a number from 1e-6 to 1e9");
    }
  };
  check_count("layers", description.cuboid.size.z);
  check_count("width", description.cuboid.size.x);
  check_count("height", description.cuboid.size.y);
  check_spacing("x", description.cuboid.spacing.x);
  check_spacing("y", description.cuboid.spacing.y);
  check_spacing("z", description.cuboid.spacing.z);
  if (description.repeated_layers.size() > kMostRepeated) {
    fail(file, std::string(kRepeatedLayers) + " has more than " + std::to_string(kMostRepeated) +
                   " numbers");
  }
  std::int64_t before = 1;
  for (const std::int64_t layer : description.repeated_layers) {
    if (layer <= before || layer > description.cuboid.size.z) {
      fail(file, std::string(kRepeatedLayers) +
                     " must be numbers of layers in their order, from 2 to grid.layers");
    }
    before = layer;
  }
  if (description.bits != 8 && description.bits != 16) {
    fail(file, "bits is " + std::to_string(description.bits) + ", must be 8 or 16");
  }
}

std::string to_toml(const SampleDescription& description) {
  // In one line: of a text in several, TOML passes over the first line's end.
  const auto quoted = [](const std::string& text) {
    const toml::value<std::string> value(text);
    std::ostringstream line;
    line << toml::toml_formatter(value, toml::format_flags::none);
    return line.str();
  };
  const auto number = [](double value) { return toml::value<double>(value); };
  const Cuboid& cuboid = description.cuboid;
  std::ostringstream out;
  out << "# A sample of Biotomy. Written once, when the sample was begun.\n"
      << "name = " << quoted(description.name) << '\n'
      << "created = " << quoted(description.created) << '\n'
      << "notes = " << quoted(description.notes) << '\n'
      << "bits = " << description.bits << "  # of one colour\n";
  if (!description.repeated_layers.empty()) {
    out << kRepeatedLayers << " = [";
    const char* separator = "";
    for (const std::int64_t layer : description.repeated_layers) {
      out << separator << layer;
      separator = ", ";
    }
    out << "]  # without a photograph: the layer before once more\n";
  }
  out << "\n[grid]\n"
      << "layers = " << cuboid.size.z << '\n'
      << "width = " << cuboid.size.x << '\n'
      << "height = " << cuboid.size.y << '\n'
      << "\n[spacing_um]\n"
      << "x = " << number(cuboid.spacing.x) << '\n'
      << "y = " << number(cuboid.spacing.y) << '\n'
      << "z = " << number(cuboid.spacing.z) << '\n';
  return out.str();
}

void refuse_unknown_keys(const toml::table& table, const std::string& prefix,
                         std::initializer_list<std::string_view> known, const fs::path& file) {
  for (const auto& [key, value] : table) {
    bool found = false;
    for (const std::string_view name : known) {
      found = found || key.str() == name;
    }
    if (!found) {
      fail(file, "unknown key " + prefix + excerpt(key.str()));
    }
  }
}

template <typename T>
T required(const toml::table& table, const std::string& prefix, const char* key,
           const fs::path& file) {
  const toml::node* node = table.get(key);
  if (node == nullptr) {
    fail(file, prefix + key + " is missing");
  }
  const std::optional<T> value = node->value<T>();
  if (!value) {
    fail(file, prefix + key + " is not of the right type");
  }
  return *value;
}

const toml::table& required_table(const toml::table& table, const char* key, const fs::path& file) {
  const toml::node* node = table.get(key);
  if (node == nullptr || !node->is_table()) {
    fail(file, std::string("the table [") + key + "] is missing");
  }
  return *node->as_table();
}

/// Whether `create` makes this before the description.
bool is_of_a_beginning(const fs::path& path) {
  std::error_code error;
  const fs::path name = path.filename();
  if (name == kLayersName || name == kRejectedName) {
    return fs::is_directory(fs::symlink_status(path, error)) && fs::is_empty(path, error);
  }
  return is_unfinished_write(path);
}

std::string read_description(const fs::path& file) {
  std::error_code error;
  const std::uintmax_t size = fs::file_size(file, error);
  if (error || size > kMostDescriptionBytes) {
    fail(file, error ? "cannot be read: " + error.message()
                     : "has " + std::to_string(size) + " bytes: it is no description of a sample");
  }
  std::string text(size, '\0');
  std::ifstream in(file, std::ios::binary);
  if (!in.read(text.data(), static_cast<std::streamsize>(size))) {
    fail(file, "cannot be read");
  }
  return text;
}

std::vector<std::int64_t> repeated_layers(const toml::table& table, const fs::path& file) {
  std::vector<std::int64_t> layers;
  const toml::node* const node = table.get(kRepeatedLayers);
  if (node == nullptr) {
    return layers;
  }
  const toml::array* const numbers = node->as_array();
  if (numbers == nullptr) {
    fail(file, std::string(kRepeatedLayers) + " is not of the right type");
  }
  for (const toml::node& number : *numbers) {
    const std::optional<std::int64_t> layer = number.value_exact<std::int64_t>();
    if (!layer) {
      fail(file, std::string(kRepeatedLayers) + " is not of the right type");
    }
    layers.push_back(*layer);
  }
  return layers;
}

SampleDescription parse(const fs::path& file) {
  toml::table table;
  try {
    table = toml::parse(read_description(file), file.string());
  } catch (const toml::parse_error& error) {
    std::ostringstream what;
    what << "line " << error.source().begin.line << ": " << excerpt(error.description());
    fail(file, what.str());
  }
  refuse_unknown_keys(
      table, "", {"name", "created", "notes", "bits", kRepeatedLayers, "grid", "spacing_um"}, file);
  const toml::table& grid = required_table(table, "grid", file);
  const toml::table& spacing = required_table(table, "spacing_um", file);
  refuse_unknown_keys(grid, "grid.", {"layers", "width", "height"}, file);
  refuse_unknown_keys(spacing, "spacing_um.", {"x", "y", "z"}, file);

  SampleDescription description;
  description.name = required<std::string>(table, "", "name", file);
  description.created = required<std::string>(table, "", "created", file);
  description.notes = required<std::string>(table, "", "notes", file);
  description.bits = required<int>(table, "", "bits", file);
  description.repeated_layers = repeated_layers(table, file);
  description.cuboid.size.z = required<std::int64_t>(grid, "grid.", "layers", file);
  description.cuboid.size.x = required<std::int64_t>(grid, "grid.", "width", file);
  description.cuboid.size.y = required<std::int64_t>(grid, "grid.", "height", file);
  description.cuboid.spacing.x = required<double>(spacing, "spacing_um.", "x", file);
  description.cuboid.spacing.y = required<double>(spacing, "spacing_um.", "y", file);
  description.cuboid.spacing.z = required<double>(spacing, "spacing_um.", "z", file);
  check(description, file);
  return description;
}

}  // namespace

SampleFolder::SampleFolder(fs::path path, SampleDescription description)
    : path_(std::move(path)), description_(std::move(description)) {}

bool SampleFolder::can_begin(const fs::path& path) {
  std::error_code error;
  if (!fs::exists(path, error)) {
    return true;
  }
  for (auto entry = fs::directory_iterator(path, error);
       !error && entry != fs::directory_iterator(); entry.increment(error)) {
    if (!is_of_a_beginning(entry->path())) {
      return false;
    }
  }
  return !error;
}

SampleFolder SampleFolder::create(const fs::path& path, const SampleDescription& description) {
  check(description, path / kDescriptionName);
  std::error_code error;
  if (!can_begin(path)) {
    fail(path, "is there already and not empty; choose another name or remove it");
  }
  const fs::path folder = fs::absolute(path).lexically_normal();
  create_folders_durably(folder / kLayersName);
  create_folders_durably(folder / kRejectedName);
  // Once more, as what was there may have been made by a program that was killed before it could.
  sync_folder(folder.parent_path());
  sync_folder(folder);
  remove_unfinished_writes(folder);
  write_durably(path / kDescriptionName, to_toml(description));
  return {path, description};
}

SampleFolder SampleFolder::open(const fs::path& path) {
  std::error_code error;
  if (!fs::exists(path, error)) {
    fail(path, error ? "cannot be reached: " + error.message()
                     : "there is no such sample folder: biotomyd makes one, or biotomy import");
  }
  if (!fs::exists(path / kDescriptionName, error)) {
    fail(path, std::string("is not a sample: there is no ") + kDescriptionName + " in it");
  }
  return {path, parse(path / kDescriptionName)};
}

fs::path SampleFolder::layer_path(std::int64_t layer) const {
  std::array<char, 32> name{};
  std::snprintf(name.data(), name.size(), "%06lld.tif", static_cast<long long>(layer));
  return path_ / kLayersName / name.data();
}

std::int64_t SampleFolder::layers_on_disk(std::int64_t first) const {
  std::int64_t next = first;
  std::error_code error;
  while (next <= description_.cuboid.size.z && fs::is_regular_file(layer_path(next), error)) {
    ++next;
  }
  return next - first;
}

fs::path SampleFolder::volume_path() const {
  return path_ / kVolumeName;
}
fs::path SampleFolder::journal_path() const {
  return path_ / kJournalName;
}
fs::path SampleFolder::hashes_path() const {
  return path_ / "layers.sha256";
}
fs::path SampleFolder::rejected_path() const {
  return path_ / kRejectedName;
}

}  // namespace biotomy::reconstruct
