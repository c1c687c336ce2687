#include "reconstruct/section/series_folder.hpp"

#include <algorithm>
#include <fstream>
#include <iterator>
#include <utility>

#include "reconstruct/absolute_folder.hpp"
#include "reconstruct/disk/durable_file.hpp"
#include "reconstruct/disk/folder_lock.hpp"
#include "reconstruct/errors.hpp"
#include "reconstruct/picture/image_file.hpp"
#include "reconstruct/section/section_record.hpp"

namespace biotomy::reconstruct {
namespace {

namespace fs = std::filesystem;

constexpr const char* kDescriptionName = "series.json";
constexpr const char* kDamagedName = "damaged.json";
constexpr const char* kFilmExtension = ".mp4";

FileDescriptor locked(const fs::path& path) {
  create_folders_durably(path);
  return make_locked_folder(
      absolute_folder(path),
      path.string() + ": another process is cutting a series into this folder");
}

bool is_digit_or_dash(char letter) {
  return letter == '-' || (letter >= '0' && letter <= '9');
}

/// Whether a file of that name is what write_durably leaves when it is killed while it writes
/// `target`: ".target." and numbers.
bool is_leftover_of(const std::string& name, const std::string& target) {
  const std::string begin = "." + target + ".";
  return name.size() > begin.size() && name.starts_with(begin) &&
         std::all_of(name.begin() + static_cast<std::ptrdiff_t>(begin.size()), name.end(),
                     is_digit_or_dash);
}

bool is_film(const fs::path& name) {
  return name.extension() == kFilmExtension ||
         name.string().ends_with(std::string(kFilmExtension) + ".partial");
}

/// Whether what was written is the description of the same series, of another state of its sample.
bool differs_in_sample_alone(const std::string& written, nlohmann::ordered_json description) {
  auto there = nlohmann::ordered_json::parse(written, nullptr, false);
  const auto name_of = [](const nlohmann::ordered_json& series) -> nlohmann::ordered_json {
    const auto sample = series.is_object() ? series.find("sample") : series.end();
    return sample != series.end() && sample->is_object() && sample->contains("name")
               ? sample->at("name")
               : nlohmann::ordered_json();
  };
  if (name_of(there).is_null() || name_of(there) != name_of(description)) {
    return false;
  }
  there.erase("sample");
  description.erase("sample");
  return there == description;
}

}  // namespace

SeriesFolder::SeriesFolder(fs::path path, const nlohmann::ordered_json& description,
                           std::vector<std::string> frames)
    : path_(std::move(path)), frames_(std::move(frames)), lock_(locked(path_)) {
  const std::string text = json_text(description, 2) + '\n';
  const fs::path file = path_ / kDescriptionName;
  if (fs::exists(file)) {
    std::ifstream in(file, std::ios::binary);
    const std::string there{std::istreambuf_iterator<char>(in), {}};
    if (there != text) {
      throw SampleError(path_.string() +
                        (differs_in_sample_alone(there, description)
                             ? ": the sample has changed since the frames in this folder were cut: "
                               "name a new folder, or remove this one"
                             : ": the folder holds another series, of other parameters or another "
                               "sample: name a new one, or remove it"));
    }
    remove_leftovers();
    refuse_strangers();
    read_damaged();
    return;
  }
  remove_leftovers();
  for (const fs::directory_entry& entry : fs::directory_iterator(path_)) {
    if (!is_film(entry.path().filename())) {
      throw SampleError(path_.string() + ": the folder is not empty: name a new one");
    }
  }
  write_durably(file, text);
}

void SeriesFolder::remove_leftovers() const {
  std::vector<fs::path> leftovers;
  for (const fs::directory_entry& entry : fs::directory_iterator(path_)) {
    const std::string name = entry.path().filename().string();
    const auto left = [&](const std::string& target) { return is_leftover_of(name, target); };
    if (name.starts_with('.') && (left(kDescriptionName) || left(kDamagedName) ||
                                  std::any_of(frames_.begin(), frames_.end(), left))) {
      leftovers.push_back(entry.path());
    }
  }
  for (const fs::path& each : leftovers) {
    fs::remove(each);
  }
}

void SeriesFolder::refuse_strangers() const {
  std::vector<std::string> known = frames_;
  known.emplace_back(kDescriptionName);
  known.emplace_back(kDamagedName);
  std::sort(known.begin(), known.end());
  for (const fs::directory_entry& entry : fs::directory_iterator(path_)) {
    const fs::path name = entry.path().filename();
    if (!is_film(name) && !std::binary_search(known.begin(), known.end(), name.string())) {
      throw SampleError(entry.path().string() +
                        ": is no part of the series in this folder: take it away");
    }
  }
}

void SeriesFolder::read_damaged() {
  const fs::path path = path_ / kDamagedName;
  if (!fs::exists(path)) {
    return;
  }
  std::ifstream in(path, std::ios::binary);
  try {
    damaged_ = nlohmann::json::parse(in).get<std::set<std::string>>();
  } catch (const nlohmann::json::exception&) {
    throw SampleError(path.string() + ": is no list of frames: remove it, and those in doubt");
  }
}

void SeriesFolder::write_damaged() const {
  if (damaged_.empty()) {
    fs::remove(path_ / kDamagedName);
  } else {
    write_durably(path_ / kDamagedName, nlohmann::json(damaged_).dump(1) + '\n');
  }
}

// A run may be killed at any time: then a good frame may stand among the damaged, never one of
// these among the good.
void SeriesFolder::store(std::size_t index, bool is_damaged,
                         const std::function<void(const fs::path&)>& write) {
  const std::string& name = frames_.at(index);
  if (is_damaged && damaged_.insert(name).second) {
    write_damaged();
  }
  write(path_ / name);
  if (!is_damaged && damaged_.erase(name) > 0) {
    write_damaged();
  }
}

std::optional<cv::Mat> SeriesFolder::frame(std::size_t index, cv::Size size, int type) const {
  const fs::path path = path_ / frames_.at(index);
  if (!fs::exists(path) || damaged_.contains(frames_.at(index))) {
    return std::nullopt;
  }
  try {
    cv::Mat picture = read_image_file(path);
    if (picture.size() == size && picture.type() == type) {
      return picture;
    }
  } catch (const SampleError&) {
    // Damaged: it is cut again.
  }
  return std::nullopt;
}

}  // namespace biotomy::reconstruct
