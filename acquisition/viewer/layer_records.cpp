#include "acquisition/viewer/layer_records.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "acquisition/quality/metrics_json.hpp"
#include "acquisition/viewer/attempt_document.hpp"
#include "acquisition/viewer/file_response.hpp"
#include "acquisition/viewer/refusal.hpp"
#include "acquisition/viewer/request_text.hpp"
#include "acquisition/viewer/section_query.hpp"
#include "reconstruct/errors.hpp"
#include "reconstruct/section/section_record.hpp"

namespace biotomy::acquisition {
namespace {

namespace fs = std::filesystem;

using nlohmann::ordered_json;
using reconstruct::json_text;
using reconstruct::SampleFolder;

constexpr std::int64_t kDefaultLimit = 100;
constexpr std::int64_t kLargestLimit = 1000;
constexpr std::int64_t kLargestId = std::numeric_limits<std::int64_t>::max();
constexpr std::size_t kMostMetrics = 64;
constexpr std::string_view kRejected = "rejected/";

ApiResponse json_response(const ordered_json& document) {
  return {.status = 200, .body = json_text(document)};
}

std::int64_t limit_of(const ApiRequest& request) {
  return number_in(request, "limit", kDefaultLimit, 1, kLargestLimit, "a number from 1 to 1000");
}

/// A text that there is, or null.
ordered_json or_null(const std::string& text) {
  return text.empty() ? ordered_json(nullptr) : ordered_json(text);
}

ordered_json layer_json(const LayerRow& row) {
  return {{"layer", row.layer},
          {"attempt", row.attempt},
          {"flagged", row.flagged},
          {"file", row.file},
          {"bytes", row.bytes},
          {"sha256", row.sha256},
          {"committed_at", or_null(row.committed_at)},
          {"reason", row.reason},
          {"metrics", metrics_json(row.metrics)}};
}

std::string layer_image_url(std::int64_t layer, const std::string& sha256) {
  return "/api/v1/layers/" + std::to_string(layer) + "/image" +
         (sha256.empty() ? "" : "?v=" + sha256.substr(0, kDigitsInAddress));
}

/// A rejected frame's picture that was kept, and is there still: only so many are.
bool is_kept(const SampleFolder& sample, const std::string& file) {
  std::error_code error;
  return file.starts_with(kRejected) &&
         fs::is_regular_file(
             fs::symlink_status(sample.rejected_path() / file.substr(kRejected.size()), error));
}

/// With the address of its picture, if there is one.
ordered_json with_image(const AttemptNote& note, const SampleFolder& sample,
                        const LayerRow* layer) {
  ordered_json document = attempt_document(note);
  if (is_kept(sample, note.file)) {
    document["image"] = "/api/v1/rejected/" + note.file.substr(kRejected.size());
  } else if (layer != nullptr && layer->attempt == note.attempt) {
    document["image"] = layer_image_url(note.layer, layer->sha256);
  } else {
    document["image"] = nullptr;
  }
  return document;
}

std::vector<std::string> names_in(const std::string& list) {
  std::vector<std::string> names;
  for (std::string& name : words_between(list, ',')) {
    if (!name.empty() && std::find(names.begin(), names.end(), name) == names.end()) {
      names.push_back(std::move(name));
    }
  }
  if (names.size() > kMostMetrics) {
    throw reconstruct::InvalidRequest("metrics: at most " + std::to_string(kMostMetrics) +
                                      " names, separated by commas");
  }
  return names;
}

ordered_json columns_json(const std::vector<std::optional<double>>& values) {
  ordered_json list = ordered_json::array();
  for (const std::optional<double>& value : values) {
    list.push_back(value ? ordered_json(*value) : ordered_json(nullptr));
  }
  return list;
}

}  // namespace

std::optional<JournalReader> LayerRecords::open_journal() const {
  if (!live_.is_there()) return std::nullopt;
  const fs::path path = live_.look()->sample.folder.journal_path();
  if (!fs::exists(path)) return std::nullopt;
  return std::optional<JournalReader>(std::in_place, path, journal_);
}

std::int64_t LayerRecords::committed() const {
  const auto journal = open_journal();
  return journal ? journal->committed_count() : live_.look()->sample.tail.layers_present();
}

LayerRow LayerRecords::layer_on_disk(const SampleFolder& sample, std::int64_t layer) const {
  const fs::path path = sample.layer_path(layer);
  LayerRow row;
  row.layer = layer;
  row.file = path.lexically_relative(sample.path()).generic_string();
  std::error_code error;
  const std::uintmax_t bytes = fs::file_size(path, error);
  row.bytes = error ? 0 : bytes;
  row.sha256 = hashes_.sha256(sample, layer);
  return row;
}

std::string LayerRecords::sha256(std::int64_t layer) const {
  const auto journal = open_journal();
  if (!journal) return hashes_.sha256(live_.look()->sample.folder, layer);
  const std::vector<LayerRow> rows = journal->committed_layers(layer, 1);
  return !rows.empty() && rows.front().layer == layer ? rows.front().sha256 : "";
}

ApiResponse LayerRecords::list(const ApiRequest& request) const {
  refuse_unknown(request.query, std::array<std::string_view, 2>{"from", "limit"});
  const std::int64_t from =
      number_in(request, "from", 1, 1, kLargestLayer, "a layer number, 1 to 999999");
  const std::int64_t limit = limit_of(request);
  std::vector<LayerRow> rows;
  std::int64_t count = 0;
  if (const auto journal = open_journal()) {
    rows = journal->committed_layers(from, limit);
    count = journal->committed_count();
  } else if (live_.is_there()) {
    const auto view = live_.look();
    count = view->sample.tail.layers_present();
    for (std::int64_t layer = from; layer <= std::min(count, from + limit - 1); ++layer) {
      rows.push_back(layer_on_disk(view->sample.folder, layer));
    }
  }
  ordered_json layers = ordered_json::array();
  for (const LayerRow& row : rows) layers.push_back(layer_json(row));
  return json_response({{"count", count}, {"layers", layers}});
}

ApiResponse LayerRecords::layer(std::int64_t layer) const {
  const auto view = live_.look();
  const SampleFolder& sample = view->sample.folder;
  std::optional<LayerRow> row;
  std::vector<AttemptNote> attempts;
  if (const auto journal = open_journal()) {
    const std::vector<LayerRow> rows = journal->committed_layers(layer, 1);
    if (!rows.empty() && rows.front().layer == layer) row = rows.front();
    attempts = journal->attempts(layer);
  } else if (layer <= view->sample.tail.layers_present()) {
    row = layer_on_disk(sample, layer);
  }
  if (!row && attempts.empty()) {
    throw Refusal(404, "there is no layer " + std::to_string(layer) + " yet: the sample has " +
                           std::to_string(committed()));
  }
  const reconstruct::GridSize& size = sample.description().cuboid.size;
  ordered_json list = ordered_json::array();
  for (const AttemptNote& note : attempts) {
    list.push_back(with_image(note, sample, row ? &*row : nullptr));
  }
  return json_response(
      {{"layer", layer},
       {"committed_at", row ? or_null(row->committed_at) : ordered_json(nullptr)},
       {"present", row.has_value()},
       {"flagged", row && row->flagged},
       {"file", row ? ordered_json(row->file) : ordered_json(nullptr)},
       {"bytes", row ? ordered_json(row->bytes) : ordered_json(nullptr)},
       {"sha256", row ? or_null(row->sha256) : ordered_json(nullptr)},
       {"width", size.x},
       {"height", size.y},
       {"image", row ? ordered_json(layer_image_url(layer, row->sha256)) : ordered_json(nullptr)},
       {"attempts", list}});
}

ApiResponse LayerRecords::rejected(const ApiRequest& request) const {
  refuse_unknown(request.query, std::array<std::string_view, 2>{"before", "limit"});
  const std::int64_t before = number_in(request, "before", kLargestId, 1, kLargestId,
                                        "the id of an attempt, a number above 0");
  const std::int64_t limit = limit_of(request);
  ordered_json list = ordered_json::array();
  std::int64_t count = 0;
  if (const auto journal = open_journal()) {
    const auto view = live_.look();
    count = journal->rejected_count();
    for (const AttemptNote& note : journal->rejected_before(before, limit)) {
      list.push_back(with_image(note, view->sample.folder, nullptr));
    }
  }
  return json_response({{"count", count}, {"rejected", list}});
}

ApiResponse LayerRecords::rejected_picture(const std::string& name,
                                           const ApiRequest& request) const {
  const auto journal = open_journal();
  const auto view = live_.look();
  const SampleFolder& sample = view->sample.folder;
  // The journal decides what the name may be: with it, no word of the request reaches the disk.
  if (!journal || name.find('/') != std::string::npos ||
      !journal->names_file(std::string(kRejected) + name)) {
    throw Refusal(404, "there is no rejected frame of that name");
  }
  if (!is_kept(sample, std::string(kRejected) + name)) {
    throw Refusal(404, "the picture of that frame is not kept any more: only the newest are");
  }
  return file_response(request, sample.rejected_path() / name, "image/jpeg");
}

ApiResponse LayerRecords::history(const ApiRequest& request) const {
  refuse_unknown(request.query, std::array<std::string_view, 2>{"metrics", "after"});
  const auto asked = request.query.find("metrics");
  const std::vector<std::string> names =
      asked == request.query.end() ? std::vector<std::string>{} : names_in(asked->second);
  const std::int64_t after =
      number_in(request, "after", 0, 0, kLargestId, "the id of an attempt, or 0");
  AttemptHistory history;
  if (const auto journal = open_journal()) {
    history = journal->history(names, after);
  } else {
    for (const std::string& name : names) history.metrics.push_back({name, {}, {}});
  }
  ordered_json metrics = ordered_json::object();
  for (const AttemptHistory::Column& column : history.metrics) {
    metrics[column.name] = {{"value", columns_json(column.value)},
                            {"limit", columns_json(column.limit)}};
  }
  return json_response({{"last", history.id.empty() ? after : history.id.back()},
                        {"id", history.id},
                        {"layer", history.layer},
                        {"attempt", history.attempt},
                        {"verdict", history.verdict},
                        {"column_um", history.column_um},
                        {"taken_at", history.taken_at},
                        {"metrics", metrics}});
}

}  // namespace biotomy::acquisition
