#include "acquisition/calibration/calibration_record.hpp"

#include <fstream>
#include <optional>
#include <sstream>

#include <nlohmann/json.hpp>

#include "acquisition/calibration/calibration_file.hpp"
#include "acquisition/calibration/light.hpp"
#include "reconstruct/disk/durable_file.hpp"
#include "reconstruct/disk/sha256.hpp"
#include "reconstruct/errors.hpp"
#include "reconstruct/picture/picture_notes.hpp"
#include "reconstruct/picture/tiff_image.hpp"
#include "reconstruct/picture/tiff_writer.hpp"

namespace biotomy::acquisition {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

constexpr const char* kLinear = "linear";

std::string record_name(FieldKind kind) {
  return std::string(to_string(kind)) + ".json";
}

std::string file_name(FieldKind kind, const std::string& sha256) {
  return std::string(to_string(kind)) + "-" + short_hash(sha256) + ".tif";
}

/// Nothing of a file that is not there.
std::optional<std::string> text_of(const fs::path& path) {
  const std::ifstream file(path);
  if (!file) return std::nullopt;
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

/// Writes the record in force, if there is one, beside the mean that it names. A record that cannot
/// be read names none.
void keep_former(const fs::path& folder, FieldKind kind) {
  const std::string text = text_of(folder / record_name(kind)).value_or("");
  const ordered_json record = ordered_json::parse(text, nullptr, false);
  if (!record.is_object() || !record.contains("file") || !record["file"].is_string()) return;
  const fs::path mean = record["file"].get<std::string>();
  if (mean.has_parent_path()) return;
  write_calibration_file(folder, mean.stem().string() + ".json", record);
}

ordered_json to_json(const CalibrationFrame& frame, FieldKind kind, const std::string& sha256) {
  ordered_json record = {
      {"kind", to_string(kind)},    {"file", file_name(kind, sha256)}, {"sha256", sha256},
      {"taken_at", frame.taken_at}, {"width", frame.mean.cols},        {"height", frame.mean.rows},
      {"bits", frame.bits},         {"frames", frame.frames},          {"transfer", kLinear}};
  record.update(taken_with(frame.settings));
  return record;
}

std::string again(FieldKind kind) {
  return std::string(": record it again with biotomy calibrate ") + to_string(kind);
}

}  // namespace

std::string short_hash(const std::string& sha256) {
  constexpr std::size_t kShown = 12;
  return sha256.substr(0, kShown);
}

const char* to_string(FieldKind kind) {
  return kind == FieldKind::flat ? "flat" : "dark";
}

std::string write_calibration_frame(const fs::path& folder, FieldKind kind,
                                    const CalibrationFrame& frame) {
  try {
    reconstruct::create_folders_durably(folder);
    const std::vector<std::byte> bytes = reconstruct::encode_tiff(frame.mean, {});
    std::string sha256 = reconstruct::sha256(bytes);
    const std::string name = file_name(kind, sha256);
    reconstruct::write_durably(folder / name, bytes);
    keep_former(folder, kind);
    write_calibration_file(folder, record_name(kind), to_json(frame, kind, sha256));
    return sha256;
  } catch (const reconstruct::SampleError& error) {
    throw CalibrationError(std::string("the calibration was not stored: ") + error.what());
  }
}

CalibrationFrame read_calibration_frame(const fs::path& folder, FieldKind kind,
                                        bridge::Transfer transfer) {
  const fs::path path = folder / record_name(kind);
  const auto text = text_of(path);
  if (!text) {
    throw CalibrationError("there is no " + std::string(to_string(kind)) + " field in " +
                           folder.string() + again(kind));
  }
  CalibrationFrame frame;
  int width = 0;
  int height = 0;
  std::string name;
  std::string told;
  try {
    const auto record = nlohmann::json::parse(*text);
    name = record.at("file").get<std::string>();
    frame.sha256 = record.at("sha256").get<std::string>();
    frame.taken_at = record.at("taken_at").get<std::string>();
    width = record.at("width").get<int>();
    height = record.at("height").get<int>();
    frame.bits = record.at("bits").get<int>();
    frame.frames = record.at("frames").get<int>();
    told = record.value("transfer", "");
    frame.settings.exposure =
        std::chrono::microseconds(record.at("exposure_us").get<std::int64_t>());
    frame.settings.gain = record.at("gain").get<double>();
    frame.settings.red_gain = record.at("red_gain").get<double>();
    frame.settings.blue_gain = record.at("blue_gain").get<double>();
  } catch (const nlohmann::json::exception&) {
    throw CalibrationError(path.string() + " is not a calibration's record" + again(kind));
  }
  if (!told.empty() && told != kLinear) {
    throw CalibrationError(path.string() + " holds values of the unknown transfer \"" + told +
                           "\"" + again(kind));
  }
  if (fs::path(name).has_parent_path()) {
    throw CalibrationError(path.string() + " names a file in another folder" + again(kind));
  }
  try {
    if (reconstruct::sha256_of_file(folder / name) != frame.sha256) {
      throw CalibrationError((folder / name).string() + " is not what was recorded" + again(kind));
    }
    frame.mean = reconstruct::read_tiff_image(folder / name);
  } catch (const reconstruct::SampleError& error) {
    throw CalibrationError(error.what() + again(kind));
  }
  if (frame.mean.cols != width || frame.mean.rows != height || frame.mean.type() != CV_16UC3) {
    throw CalibrationError(path.string() + " and its image do not agree" + again(kind));
  }
  if (told.empty()) frame.mean = light_of(frame.mean, transfer);
  return frame;
}

}  // namespace biotomy::acquisition
