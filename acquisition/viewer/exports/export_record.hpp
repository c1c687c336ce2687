#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace biotomy::acquisition {

enum class ExportState { queued, running, done, failed, cancelled };

const char* to_string(ExportState state);

struct ExportFile {
  std::string name;
  std::uint64_t bytes = 0;
};

/// What there is to be told of an export.
struct ExportRecord {
  std::string id;    ///< of digits, letters and dashes; sorted, ids are in the order of asking
  std::string kind;  ///< "section" or "series"
  ExportState state = ExportState::queued;
  std::int64_t done = 0;
  std::int64_t total = 0;
  std::string unit;  ///< "rows" or "frames"
  std::optional<double> seconds_left;
  std::string sentence;    ///< how it is, for a person
  std::string created_at;  ///< ISO 8601, UTC
  std::string command;
  std::vector<ExportFile> files;

  bool ended() const { return state != ExportState::queued && state != ExportState::running; }
  std::uint64_t bytes() const;
};

/// As the API gives it.
nlohmann::ordered_json to_json(const ExportRecord& record);

/// Of an export that was done and is found again, from the JSON of its folder. Nothing when it is
/// none of ours.
std::optional<ExportRecord> export_record(const std::string& text, const std::string& id);

/// Whether a name may be an export's.
bool is_export_id(const std::string& name);

}  // namespace biotomy::acquisition
