#include "acquisition/viewer/exports/export_queue.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdio>
#include <deque>
#include <limits>
#include <mutex>
#include <random>
#include <thread>
#include <utility>
#include <vector>

#include <unistd.h>

#include "acquisition/low_priority.hpp"
#include "acquisition/records/utc_time.hpp"
#include "acquisition/viewer/exports/export_folder.hpp"
#include "acquisition/viewer/exports/export_order.hpp"
#include "acquisition/viewer/exports/export_work.hpp"
#include "acquisition/viewer/file_response.hpp"
#include "acquisition/viewer/picture_task.hpp"
#include "acquisition/viewer/refusal.hpp"
#include "acquisition/viewer/viewer_settings.hpp"
#include "reconstruct/errors.hpp"
#include "reconstruct/interruption.hpp"
#include "reconstruct/section/section_record.hpp"

namespace biotomy::acquisition {
namespace {

using Clock = std::chrono::steady_clock;
using reconstruct::json_text;
using std::chrono::milliseconds;

constexpr std::size_t kMostWaiting = 8;
constexpr std::size_t kMostKept = 20;
constexpr std::uint64_t kMostKeptBytes = std::uint64_t{8} << 30;
constexpr std::int64_t kMostPictureBytes = 2'000'000'000;  // as of the commands
constexpr int kNice = 10;
constexpr milliseconds kBetweenProgress{250};
constexpr milliseconds kBetweenLooksAtDisk{1000};
constexpr std::chrono::seconds kLikelyWait{10};  // until one of those that wait is begun
constexpr double kLeastSecondsToJudgeBy = 0.5;

/// A picture and what it is encoded into are in memory together.
std::int64_t most_picture_bytes() {
  const auto pages = static_cast<std::int64_t>(::sysconf(_SC_PHYS_PAGES));
  const auto page = static_cast<std::int64_t>(::sysconf(_SC_PAGESIZE));
  return pages > 0 && page > 0 ? std::min(kMostPictureBytes, pages * page / 4) : kMostPictureBytes;
}

/// Sorted, they are in the order of time.
std::string new_id(std::chrono::system_clock::time_point now) {
  std::string id;
  for (const char letter : utc_text(now)) {
    if (letter >= '0' && letter <= '9') id += letter;
  }
  std::array<char, 16> chance{};
  std::snprintf(chance.data(), chance.size(), "-%08x", std::random_device()());
  return id + chance.data();
}

struct Job {
  ExportRecord record;
  ExportOrder order;
  std::atomic<bool> given_up{false};
};
using JobPointer = std::shared_ptr<Job>;

std::string content_type_of_file(const std::string& name) {
  if (name.ends_with(".zip")) return "application/zip";
  if (name.ends_with(".mp4")) return "video/mp4";
  return content_type_of(format_of(name.substr(name.rfind('.') + 1)));
}

/// A name for the browser's folder of downloads.
std::string download_name(const std::string& sample, const std::string& name) {
  std::string plain;
  for (const char letter : sample) {
    const bool harmless = (letter >= 'a' && letter <= 'z') || (letter >= 'A' && letter <= 'Z') ||
                          (letter >= '0' && letter <= '9') || letter == '-' || letter == '_';
    plain += harmless ? letter : '-';
  }
  return (plain.empty() ? "sample" : plain) + '-' + name;
}

}  // namespace

struct ExportQueue::State {
  LiveSample& live;
  tbb::task_arena& arena;
  ExportSettings settings;
  ExportFolder folder;
  std::int64_t max_bytes = most_picture_bytes();
  mutable std::mutex mutex;
  std::mutex telling;  // taken before `mutex`: changes are told in the order in which they are made
  std::condition_variable woken;
  bool ending = false;
  std::function<void(std::string)> listener;
  std::deque<JobPointer> jobs;  // in the order of asking, ended ones too
  std::thread worker;

  State(LiveSample& sample, tbb::task_arena& threads, ExportSettings chosen)
      : live(sample), arena(threads), settings(std::move(chosen)), folder(settings.folder) {
    for (ExportRecord& record : folder.sweep()) {
      auto job = std::make_shared<Job>();
      job->record = std::move(record);
      jobs.push_back(std::move(job));
    }
  }

  std::uint64_t bytes_to_spare() const {
    if (settings.bytes_to_spare) return settings.bytes_to_spare();
    const std::uint64_t free = folder.free_bytes();
    return free > kLeftFree ? free - kLeftFree : 0;
  }

  JobPointer find(const std::string& id) const {
    const auto found = std::find_if(jobs.begin(), jobs.end(),
                                    [&](const JobPointer& job) { return job->record.id == id; });
    if (found == jobs.end()) throw Refusal(404, "there is no such export");
    return *found;
  }

  /// Without the lock: whoever listens may look at the exports.
  void tell(const std::string& json) {
    std::function<void(std::string)> told;
    {
      const std::lock_guard lock(mutex);
      told = listener;
    }
    if (told) told(json);
  }

  /// Changes a job's record and tells of it.
  template <typename Change>
  void change(Job& job, Change what) {
    const std::lock_guard in_order(telling);
    std::string json;
    {
      const std::lock_guard lock(mutex);
      what(job.record);
      json = json_text(to_json(job.record));
    }
    tell(json);
  }

  JobPointer next() {
    std::unique_lock lock(mutex);
    for (;;) {
      if (ending) return nullptr;
      const auto found = std::find_if(jobs.begin(), jobs.end(), [](const JobPointer& job) {
        return job->record.state == ExportState::queued;
      });
      if (found != jobs.end()) {
        (*found)->record.state = ExportState::running;  // from here on only the worker ends it
        return *found;
      }
      woken.wait(lock);
    }
  }

  void work() {
    lower_priority(kNice, DiskShare::idle);
    while (const JobPointer job = next()) {
      change(*job, [](ExportRecord& record) { record.sentence = "being made"; });
      make(*job);
      keep_the_last();
    }
  }

  void make(Job& job) {
    ExportState state = ExportState::failed;
    std::string sentence;
    try {
      run(job);
      return;
    } catch (const reconstruct::Interrupted& interrupted) {
      state = ExportState::cancelled;
      sentence = interrupted.what();
    } catch (const std::exception& error) {
      sentence = error.what();
    }
    change(job, [&](ExportRecord& record) {
      record.state = state;
      record.seconds_left.reset();
      record.sentence = sentence;
    });
  }

  void run(Job& job) {
    const auto view = look_at_layers(live);
    const std::unique_ptr<UnfinishedExport> unfinished = folder.begin(job.record.id);
    const auto start = Clock::now();
    auto told = start - kBetweenProgress;
    auto looked = start - kBetweenLooksAtDisk;
    ExportBounds bounds;
    bounds.max_bytes = max_bytes;
    bounds.cache_bytes = settings.cache_bytes;
    bounds.look_up = [&] {
      reconstruct::stop_here_if([&] { return job.given_up.load(); }, "cancelled");
      if (Clock::now() - looked < kBetweenLooksAtDisk) return;
      looked = Clock::now();
      if (bytes_to_spare() == 0) {
        throw reconstruct::SampleError("the disk has no more room to spare; nothing was kept");
      }
    };
    bounds.progress = [&](std::int64_t done, std::int64_t total) {
      const auto now = Clock::now();
      if (now - told < kBetweenProgress && done != total) return;
      told = now;
      const double seconds = std::chrono::duration<double>(now - start).count();
      change(job, [&](ExportRecord& record) {
        record.done = done;
        record.total = total;
        if (seconds > kLeastSecondsToJudgeBy && done > 0) {
          record.seconds_left =
              seconds * static_cast<double>(total - done) / static_cast<double>(done);
        }
      });
    };
    const std::vector<ExportFile> files =
        arena.execute([&] { return make_export(job.order, *view, unfinished->path(), bounds); });
    bounds.look_up();
    ExportRecord finished;
    {
      const std::lock_guard lock(mutex);
      finished = job.record;
    }
    finished.state = ExportState::done;
    finished.done = finished.total;
    finished.seconds_left.reset();
    finished.sentence = "done";
    finished.files = files;
    unfinished->publish(finished);
    change(job, [&](ExportRecord& record) { record = finished; });
  }

  /// The oldest ended ones go.
  void keep_the_last() {
    std::vector<JobPointer> gone;
    {
      const std::lock_guard lock(mutex);
      std::size_t ended = 0;
      std::uint64_t bytes = 0;
      for (auto job = jobs.rbegin(); job != jobs.rend(); ++job) {
        if (!(*job)->record.ended()) continue;
        ++ended;
        bytes += (*job)->record.bytes();
        // The newest stays, however large: somebody waited for it.
        if (ended > 1 && (ended > kMostKept || bytes > kMostKeptBytes)) gone.push_back(*job);
      }
      for (const JobPointer& job : gone) std::erase(jobs, job);
    }
    for (const JobPointer& job : gone) folder.remove(job->record);
  }
};

ExportQueue::ExportQueue(LiveSample& live, tbb::task_arena& arena, ExportSettings settings)
    : state_(std::make_unique<State>(live, arena, std::move(settings))) {
  state_->keep_the_last();
  state_->worker = std::thread([state = state_.get()] { state->work(); });
}

ExportQueue::~ExportQueue() {
  {
    const std::lock_guard lock(state_->mutex);
    state_->ending = true;
    state_->listener = nullptr;
    for (const JobPointer& job : state_->jobs) job->given_up = true;
  }
  state_->woken.notify_all();
  state_->worker.join();
}

void ExportQueue::on_change(std::function<void(std::string json)> listener) {
  const std::lock_guard lock(state_->mutex);
  state_->listener = std::move(listener);
}

ApiResponse ExportQueue::add(const ApiRequest& request) {
  auto job = std::make_shared<Job>();
  job->order = export_order(request.body);
  const auto view = look_at_layers(state_->live);
  const ExportPlan plan = export_plan(job->order, *view, state_->max_bytes);
  const auto now = std::chrono::system_clock::now();
  job->record = {.id = new_id(now),
                 .kind = job->order.section ? "section" : "series",
                 .state = ExportState::queued,
                 .done = 0,
                 .total = plan.total,
                 .unit = plan.unit,
                 .seconds_left = std::nullopt,
                 .sentence = "waits for its turn",
                 .created_at = utc_text(now),
                 .command = plan.command,
                 .files = {}};
  const std::uint64_t spare = state_->bytes_to_spare();
  if (plan.bytes > spare) {
    throw Refusal(507, "the export may take " + std::to_string(plan.bytes / 1'000'000) +
                           " MB, and the disk has " + std::to_string(spare / 1'000'000) +
                           " MB to spare: remove older exports, or ask for a larger pixel");
  }
  ApiResponse response{.status = 202, .body = json_text(to_json(job->record))};
  response.headers["Location"] = "/api/v1/exports/" + job->record.id;
  const std::lock_guard in_order(state_->telling);
  {
    const std::lock_guard lock(state_->mutex);
    const auto waiting = std::count_if(
        state_->jobs.begin(), state_->jobs.end(),
        [](const JobPointer& other) { return other->record.state == ExportState::queued; });
    if (static_cast<std::size_t>(waiting) >= kMostWaiting) {
      return later_response(429,
                            std::to_string(kMostWaiting) +
                                " exports wait already: ask again when one of them is done",
                            kLikelyWait);
    }
    state_->jobs.push_back(job);
  }
  state_->tell(response.body);
  state_->woken.notify_all();
  return response;
}

ApiResponse ExportQueue::list() const {
  nlohmann::ordered_json exports = nlohmann::ordered_json::array();
  const std::lock_guard lock(state_->mutex);
  for (auto job = state_->jobs.rbegin(); job != state_->jobs.rend(); ++job) {
    exports.push_back(to_json((*job)->record));
  }
  return {.status = 200, .body = json_text({{"exports", exports}})};
}

ApiResponse ExportQueue::one(const std::string& id) const {
  const std::lock_guard lock(state_->mutex);
  return {.status = 200, .body = json_text(to_json(state_->find(id)->record))};
}

ApiResponse ExportQueue::remove(const std::string& id) {
  const std::lock_guard in_order(state_->telling);
  std::string json;
  ExportRecord removed;
  {
    const std::lock_guard lock(state_->mutex);
    const JobPointer job = state_->find(id);
    ExportRecord& record = job->record;
    if (record.ended()) {
      removed = record;
      std::erase(state_->jobs, job);
    } else if (record.state == ExportState::running) {
      job->given_up = true;  // the thread that makes it ends it
      record.sentence = "being cancelled";
    } else {
      record.state = ExportState::cancelled;
      record.sentence = "cancelled";
    }
    json = json_text(to_json(record));
  }
  if (removed.ended()) {
    state_->folder.remove(removed);
  } else {
    state_->tell(json);
    state_->keep_the_last();
  }
  return {.status = 200, .body = json};
}

ApiResponse ExportQueue::file(const std::string& id, const std::string& name,
                              const ApiRequest& request) const {
  {
    const std::lock_guard lock(state_->mutex);
    const std::vector<ExportFile>& files = state_->find(id)->record.files;
    if (std::none_of(files.begin(), files.end(),
                     [&](const ExportFile& file) { return file.name == name; })) {
      throw Refusal(404, "the export has no file of that name");
    }
  }
  ApiResponse response =
      file_response(request, state_->folder.file(id, name), content_type_of_file(name));
  if (response.file) {
    response.headers["Content-Disposition"] =
        "attachment; filename=\"" +
        download_name(state_->live.look()->sample.folder.description().name, name) + '"';
  }
  return response;
}

}  // namespace biotomy::acquisition
