#include "acquisition/viewer/exports/export_record.hpp"

#include <algorithm>
#include <array>
#include <string_view>

namespace biotomy::acquisition {
namespace {

using nlohmann::ordered_json;

constexpr std::size_t kLongestId = 40;
/// The names under which exports' files lie: none else is ever looked for.
constexpr std::array<std::string_view, 5> kFileNames = {"section.png", "section.jpg", "section.tif",
                                                        "series.zip", "series.mp4"};

}  // namespace

const char* to_string(ExportState state) {
  switch (state) {
    case ExportState::queued:
      return "queued";
    case ExportState::running:
      return "running";
    case ExportState::done:
      return "done";
    case ExportState::failed:
      return "failed";
    case ExportState::cancelled:
      break;
  }
  return "cancelled";
}

std::uint64_t ExportRecord::bytes() const {
  std::uint64_t sum = 0;
  for (const ExportFile& file : files) sum += file.bytes;
  return sum;
}

ordered_json to_json(const ExportRecord& record) {
  ordered_json files = ordered_json::array();
  for (const ExportFile& file : record.files) {
    files.push_back({{"name", file.name},
                     {"bytes", file.bytes},
                     {"url", "/api/v1/exports/" + record.id + "/files/" + file.name}});
  }
  return {{"id", record.id},
          {"kind", record.kind},
          {"state", to_string(record.state)},
          {"done", record.done},
          {"total", record.total},
          {"unit", record.unit},
          {"seconds_left",
           record.seconds_left ? ordered_json(*record.seconds_left) : ordered_json(nullptr)},
          {"sentence", record.sentence},
          {"created_at", record.created_at},
          {"command", record.command},
          {"files", files}};
}

std::optional<ExportRecord> export_record(const std::string& text, const std::string& id) {
  try {
    const ordered_json document = ordered_json::parse(text);
    ExportRecord record{.id = id,
                        .kind = document.at("kind").get<std::string>(),
                        .state = ExportState::done,
                        .done = document.at("done").get<std::int64_t>(),
                        .total = document.at("total").get<std::int64_t>(),
                        .unit = document.at("unit").get<std::string>(),
                        .seconds_left = std::nullopt,
                        .sentence = document.at("sentence").get<std::string>(),
                        .created_at = document.at("created_at").get<std::string>(),
                        .command = document.at("command").get<std::string>(),
                        .files = {}};
    for (const ordered_json& file : document.at("files")) {
      const auto name = file.at("name").get<std::string>();
      if (std::find(kFileNames.begin(), kFileNames.end(), name) == kFileNames.end()) {
        return std::nullopt;
      }
      record.files.push_back({name, file.at("bytes").get<std::uint64_t>()});
    }
    const bool ours = document.at("id") == id && document.at("state") == "done";
    return ours ? std::optional(record) : std::nullopt;
  } catch (const nlohmann::json::exception&) {
    return std::nullopt;
  }
}

bool is_export_id(const std::string& name) {
  return !name.empty() && name.size() <= kLongestId &&
         std::all_of(name.begin(), name.end(), [](char letter) {
           return (letter >= '0' && letter <= '9') || (letter >= 'a' && letter <= 'z') ||
                  letter == '-';
         });
}

}  // namespace biotomy::acquisition
