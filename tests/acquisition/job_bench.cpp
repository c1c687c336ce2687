#include "tests/acquisition/job_bench.hpp"

#include <fstream>
#include <utility>

#include <SQLiteCpp/SQLiteCpp.h>

#include "acquisition/records/utc_time.hpp"
#include "reconstruct/errors.hpp"

namespace biotomy::tests {

using namespace acquisition;

JobBench::JobBench() {
  settings.plan.sample = folder.path() / "knee";
  settings.plan.name = "knee";
  settings.plan.layers = 5;
  settings.plan.layer_thickness = {20.0};
  settings.plan.first_face = {1000.0};
  settings.plan.clear_duration = std::chrono::milliseconds(50);
  settings.plan.settle_duration = std::chrono::milliseconds(40);
  settings.plan.lamp_warm_up = std::chrono::milliseconds(40);
  // The fake's axes jump at the end of a command: until then they stand still.
  settings.limits.axis_stall = settings.limits.standstill = std::chrono::hours(24);
  settings.focus.start = {590.0};
  surroundings.wall_clock = [this] {
    return wall_clock_start + std::chrono::system_clock::duration(
                                  std::chrono::duration_cast<std::chrono::system_clock::duration>(
                                      now.time_since_epoch()));
  };
  surroundings.free_bytes = [this](const auto&) { return free_bytes; };
  surroundings.prepare_layer = [this](const std::filesystem::path& path, const cv::Mat& image,
                                      const auto&, const auto&) -> reconstruct::PublishLayer {
    if (!store_failure.empty()) throw reconstruct::SampleError(store_failure);
    const auto held = std::shared_ptr<int>(new int(++prepared), [this](const int* number) {
      if (!worker.at_work) ++released_by_control;
      delete number;
    });
    last_prepared = held;
    return [this, path, image = image.clone(), held] {
      std::ofstream(path) << image.cols << " x " << image.rows;
      written.push_back(path.filename().string());
      images[path] = image;
      return reconstruct::StoredLayer{.bytes = std::filesystem::file_size(path), .sha256 = "abc"};
    };
  };
  surroundings.read_layer = [this](const std::filesystem::path& path) { return images.at(path); };
  surroundings.open_volume = [this](const auto&, const auto&) {
    return [this](std::int64_t available, bool finish, const auto& progress) {
      if (finish) in_volume = available;
      volume_finished = finish;
      progress(in_volume);
    };
  };
  start_daemon();
}

void JobBench::start_daemon() {
  job.reset();
  job = std::make_unique<Job>(
      settings,
      JobParts{stage, lines, watched_camera, *job_worker, volume_worker, event_worker, desk, board,
               plain_camera, &watched_camera},
      surroundings,
      take_over_earlier_run(settings.plan.sample, utc_text(surroundings.wall_clock())));
  tick();
}

void JobBench::tick(int times) {
  for (int i = 0; i < times; ++i) {
    now += std::chrono::milliseconds(20);
    job->tick(now);
  }
}

bool JobBench::reach(JobState wanted, int ticks) {
  for (int i = 0; i < ticks && state() != wanted; ++i) tick();
  return state() == wanted;
}

bool JobBench::reach_committed(std::int64_t layers, int ticks) {
  for (int i = 0; i < ticks && board.look()->committed < layers; ++i) tick();
  return board.look()->committed >= layers;
}

OperatorReply JobBench::say(OperatorCommand command) {
  auto reply = desk.post(command, "");
  for (int i = 0; i < 1000 && !is_ready(reply); ++i) tick();
  return is_ready(reply) ? reply.get() : OperatorReply{false, "no answer"};
}

void JobBench::start_job() {
  say(OperatorCommand::start);
}

std::string JobBench::alarm() const {
  const auto status = board.look();
  return status->alarm ? status->alarm->cause : "";
}

std::string JobBench::events_of_kind(const std::string& kind) const {
  const SQLite::Database database((settings.plan.sample / "journal.sqlite").string());
  SQLite::Statement select(database, "SELECT text FROM events WHERE kind = ? ORDER BY id");
  select.bind(1, kind);
  std::string texts;
  while (select.executeStep()) texts += select.getColumn(0).getString() + "\n";
  return texts;
}

std::int64_t JobBench::count_rows(const std::string& table, const std::string& where) const {
  SQLite::Database database((settings.plan.sample / "journal.sqlite").string());
  return database.execAndGet("SELECT count(*) FROM " + table + " WHERE " + where).getInt64();
}

}  // namespace biotomy::tests
