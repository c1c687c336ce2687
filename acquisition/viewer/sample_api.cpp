#include "acquisition/viewer/sample_api.hpp"

#include <algorithm>
#include <array>
#include <exception>
#include <string_view>
#include <thread>
#include <utility>

#include <nlohmann/json.hpp>
#include <oneapi/tbb/task_arena.h>

#include "acquisition/log.hpp"
#include "acquisition/records/journal_error.hpp"
#include "acquisition/records/journal_reader.hpp"
#include "acquisition/viewer/live_sample.hpp"
#include "acquisition/viewer/refusal.hpp"
#include "acquisition/viewer/sample_json.hpp"
#include "acquisition/viewer/section_pictures.hpp"
#include "reconstruct/errors.hpp"
#include "reconstruct/interruption.hpp"

namespace biotomy::acquisition {
namespace {

constexpr const char* kSample = "/api/v1/sample";
constexpr const char* kSection = "/api/v1/section";
constexpr const char* kOutline = "/api/v1/section/outline";

/// Threads that ask for pictures: the server's and the exports'.
constexpr unsigned kAskingThreads = 3;

int threads_of(const ViewerSettings& settings) {
  if (settings.threads > 0) return settings.threads;
  return static_cast<int>(std::max(1U, std::thread::hardware_concurrency() / 2));
}

}  // namespace

struct SampleApi::State {
  ViewerSettings settings;
  mutable LiveSample live;
  mutable tbb::task_arena arena;
  SectionPictures sections;

  State(std::filesystem::path sample, ViewerSettings chosen)
      : settings(std::move(chosen)),
        live(std::move(sample), settings.cache_bytes),
        arena(threads_of(settings) + static_cast<int>(kAskingThreads), kAskingThreads,
              tbb::task_arena::priority::low),
        sections(live, arena) {}

  std::int64_t committed(const SampleView& view) const {
    const std::filesystem::path journal = view.sample.folder.journal_path();
    if (!std::filesystem::exists(journal)) return view.sample.tail.layers_present();
    return JournalReader(journal).committed_count();
  }

  ApiResponse sample() const {
    const auto view = live.look();
    return {.status = 200, .body = sample_json(*view, committed(*view))};
  }

  ApiResponse route(const ApiRequest& request) const {
    if (!std::filesystem::exists(live.folder() / "sample.toml")) {
      throw Refusal(404, "there is no sample yet at " + live.folder().string());
    }
    if (request.path == kSample) return sample();
    if (request.path == kSection) return sections.picture(request);
    if (request.path == kOutline) return sections.outline(request);
    throw Refusal(404, "there is no " + request.path);
  }
};

SampleApi::SampleApi(std::filesystem::path sample, ViewerSettings settings)
    : state_(std::make_unique<State>(std::move(sample), std::move(settings))) {}

SampleApi::~SampleApi() = default;

bool SampleApi::answers(const ApiRequest& request) const {
  static constexpr std::array kPaths = {kSample, kSection, kOutline};
  return std::find(kPaths.begin(), kPaths.end(), request.path) != kPaths.end();
}

Lane SampleApi::lane(const ApiRequest& request) {
  return request.path == kSection ? Lane::pictures : Lane::quick;
}

bool SampleApi::is_command(const ApiRequest& request) {
  return request.method != "GET" && request.method != "OPTIONS";
}

ApiResponse SampleApi::answer(const ApiRequest& request) const {
  try {
    if (request.method != "GET") {
      ApiResponse response =
          error_response(405, request.path + " takes GET, not " + request.method);
      response.headers["Allow"] = "GET";
      return response;
    }
    return state_->route(request);
  } catch (const Refusal& refusal) {
    return error_response(refusal.status(), refusal.what());
  } catch (const reconstruct::InvalidRequest& error) {
    return error_response(400, error.what());
  } catch (const reconstruct::Interrupted& error) {
    return error_response(503, error.what());
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
  nlohmann::ordered_json event = {{"committed", 0}, {"layers_present", 0}};
  try {
    const auto view = state_->live.look();
    event = {{"committed", state_->committed(*view)},
             {"layers_present", view->sample.tail.layers_present()}};
  } catch (const std::exception&) {
    // There is no sample yet, or none that can be read: whoever asks for it is told.
  }
  event["generation"] = state_->live.generation();
  return event.dump();
}

void SampleApi::on_export(std::function<void(std::string json)> listener) {
  (void)listener;
}

}  // namespace biotomy::acquisition
