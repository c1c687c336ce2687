#include "acquisition/viewer/sample_api.hpp"

#include <algorithm>
#include <array>
#include <exception>
#include <string_view>
#include <thread>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>
#include <oneapi/tbb/task_arena.h>

#include "acquisition/log.hpp"
#include "acquisition/records/journal_error.hpp"
#include "acquisition/viewer/exports/export_queue.hpp"
#include "acquisition/viewer/layer_images.hpp"
#include "acquisition/viewer/layer_records.hpp"
#include "acquisition/viewer/live_sample.hpp"
#include "acquisition/viewer/refusal.hpp"
#include "acquisition/viewer/request_text.hpp"
#include "acquisition/viewer/sample_json.hpp"
#include "acquisition/viewer/section_task.hpp"
#include "acquisition/viewer/series_pictures.hpp"
#include "acquisition/viewer/volume_files.hpp"
#include "reconstruct/errors.hpp"
#include "reconstruct/excerpt.hpp"
#include "reconstruct/interruption.hpp"
#include "reconstruct/sample/sample_folder.hpp"

namespace biotomy::acquisition {
namespace {

constexpr std::string_view kApi = "/api/v1/";
constexpr std::int64_t kLargestTile = 1'000'000;

constexpr std::string_view kVolume = "/volume.ome.zarr/";

/// The words of a path below kApi, or none of another one.
std::vector<std::string> words_of(const std::string& path) {
  if (!path.starts_with(kApi)) return {};
  return words_between(std::string_view(path).substr(kApi.size()), '/');
}

[[noreturn]] void refuse_path(const std::string& path) {
  throw Refusal(404, "there is no " + reconstruct::excerpt(path));
}

/// Threads that ask for pictures: the server's and the exports'.
constexpr unsigned kAskingThreads = 3;

/// Threads that help whoever asks. TBB has one fewer than there are processors.
int helpers_of(const ViewerSettings& settings) {
  const int processors = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
  return std::clamp(settings.threads, 1, processors) - 1;
}

}  // namespace

struct SampleApi::State {
  ViewerSettings settings;
  mutable LiveSample live;
  mutable tbb::task_arena arena;
  SeriesPictures series;
  LayerRecords records;
  mutable LayerImages images;
  VolumeFiles volume;
  mutable ExportQueue exports;

  State(const std::filesystem::path& sample, ViewerSettings chosen)
      : settings(std::move(chosen)),
        live(sample, settings.cache_bytes),
        arena(helpers_of(settings) + static_cast<int>(kAskingThreads), kAskingThreads,
              tbb::task_arena::priority::low),
        series(live),
        records(live, settings.journal),
        images(live, records, arena, settings.decoded_bytes),
        volume(live.folder() / reconstruct::SampleFolder::kVolumeName),
        exports(
            live, arena,
            {settings.exports.empty() ? default_exports_folder(live.folder()) : settings.exports,
             settings.bytes_to_spare, settings.cache_bytes}) {}

  ApiResponse sample() const {
    const auto view = live.look();
    return {.status = 200, .body = sample_json(*view, records.committed())};
  }

  /// `words` are those after "layers".
  ApiResponse layers(const std::vector<std::string>& words, const ApiRequest& request) const {
    if (words.empty()) return records.list(request);
    const auto layer = whole_number(words[0], 1, kLargestLayer);
    if (!layer) {
      throw Refusal(
          404, "'" + reconstruct::excerpt(words[0]) + "' is no layer: they are numbered from 1");
    }
    if (words.size() == 1) return records.layer(*layer);
    if (words.size() == 2 && words[1] == "image") return images.image(*layer, request);
    if (words.size() == 2 && words[1] == "sharpness") return images.sharpness(*layer, request);
    if (words.size() == 5 && words[1] == "tiles") {
      const auto number = [&](std::size_t word) {
        const auto value = whole_number(words[word], 0, kLargestTile);
        if (!value) refuse_path(request.path);
        return static_cast<int>(*value);
      };
      return images.tile(*layer, number(2), number(3), number(4), request);
    }
    refuse_path(request.path);
  }

  /// `words` are those after "exports".
  ApiResponse answer_exports(const std::vector<std::string>& words,
                             const ApiRequest& request) const {
    if (words.empty()) {
      if (request.method == "POST") return exports.add(request);
      return request.method == "GET" ? exports.list() : wrong_method(request, "GET, POST");
    }
    if (words.size() == 1) {
      if (request.method == "DELETE") return exports.remove(words[0]);
      return request.method == "GET" ? exports.one(words[0]) : wrong_method(request, "GET, DELETE");
    }
    if (words.size() != 3 || words[1] != "files") refuse_path(request.path);
    if (request.method != "GET") return wrong_method(request, "GET");
    return exports.file(words[0], words[2], request);
  }

  ApiResponse route(const ApiRequest& request) const {
    const std::vector<std::string> words = words_of(request.path);
    const std::vector<std::string> rest(words.empty() ? words.begin() : words.begin() + 1,
                                        words.end());
    const std::string& first = words.empty() ? request.path : words[0];
    if (first != "exports" && request.method != "GET") return wrong_method(request, "GET");
    // A page that is opened before a job's first layer asks for its lists: there is nothing in
    // them.
    const bool is_list = rest.empty() && (first == "layers" || first == "rejected" ||
                                          first == "history" || first == "exports");
    if (!is_list && !live.is_there()) {
      throw Refusal(404, "there is no sample yet at " + live.folder().string());
    }
    if (request.path.starts_with(kVolume)) {
      return volume.answer(request.path.substr(kVolume.size()), request);
    }
    if (first == "exports") return answer_exports(rest, request);
    if (first == "layers") return layers(rest, request);
    if (first == "rejected" && rest.empty()) return records.rejected(request);
    if (first == "rejected" && rest.size() == 1) return records.rejected_picture(rest[0], request);
    if (first == "section" && rest.empty()) {
      return picture_of(section_task(live, request.query), request, arena);
    }
    if (first == "section" && rest == std::vector<std::string>{"outline"}) {
      return outline_of(section_task(live, request.query));
    }
    if (first == "series" && rest == std::vector<std::string>{"frames"}) {
      return series.frames(request);
    }
    if (first == "series" && rest == std::vector<std::string>{"frame"}) {
      return picture_of(series.frame_task(request), request, arena);
    }
    if (first == "sample" && rest.empty()) return sample();
    if (first == "history" && rest.empty()) return records.history(request);
    refuse_path(request.path);
  }
};

SampleApi::SampleApi(const std::filesystem::path& sample, ViewerSettings settings)
    : state_(std::make_unique<State>(sample, std::move(settings))) {}

SampleApi::~SampleApi() = default;

bool SampleApi::answers(const ApiRequest& request) const {
  static constexpr std::array<std::string_view, 7> kFirst = {
      "sample", "layers", "rejected", "history", "section", "series", "exports"};
  if (request.path.starts_with(kVolume)) return true;
  const std::vector<std::string> words = words_of(request.path);
  return !words.empty() && std::find(kFirst.begin(), kFirst.end(), words[0]) != kFirst.end();
}

Lane SampleApi::lane(const ApiRequest& request) {
  const std::vector<std::string> words = words_of(request.path);
  if (words.empty()) return Lane::files;
  const bool draws = (words[0] == "section" && words.size() == 1) ||
                     (words[0] == "series" && words.back() == "frame") ||
                     (words[0] == "layers" && words.size() > 2);
  if (draws) return Lane::pictures;
  const bool sends =
      (words[0] == "rejected" && words.size() > 1) || (words[0] == "exports" && words.size() > 2);
  return sends ? Lane::files : Lane::quick;
}

bool SampleApi::is_command(const ApiRequest& request) {
  return request.method != "GET";
}

ApiResponse SampleApi::answer(const ApiRequest& request) const {
  try {
    return state_->route(request);
  } catch (const Refusal& refusal) {
    return error_response(refusal.status(), refusal.what());
  } catch (const reconstruct::InvalidRequest& error) {
    return error_response(400, error.what());
  } catch (const reconstruct::Interrupted& error) {
    // Too much for one answer. Not 503: who waits would ask for the same again and again.
    return error_response(413, error.what());
  } catch (const reconstruct::SampleError& error) {
    return error_response(422, error.what());
  } catch (const JournalError& error) {
    return error_response(503, error.what());
  } catch (const std::exception& error) {
    log_error("viewer", request.path + ": " + error.what());
    return error_response(500, error.what());
  }
}

std::uint64_t SampleApi::generation() const {
  return state_->live.generation();
}

std::string SampleApi::sample_event() const {
  nlohmann::ordered_json event = {{"committed", 0}, {"layers_present", 0}, {"created", nullptr}};
  try {
    const auto view = state_->live.look();
    event = {{"committed", state_->records.committed()},
             {"layers_present", view->sample.tail.layers_present()},
             {"created", view->sample.folder.description().created}};
  } catch (const std::exception&) {
    // There is no sample yet, or none that can be read: whoever asks for it is told.
  }
  event["generation"] = state_->live.generation();
  return event.dump();
}

void SampleApi::on_export(std::function<void(std::string json)> listener) {
  state_->exports.on_change(std::move(listener));
}

}  // namespace biotomy::acquisition
