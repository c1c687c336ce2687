#include "acquisition/service/daemon.hpp"

#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <utility>

#include <pthread.h>

#include "acquisition/calibration/corrected_camera.hpp"
#include "acquisition/http/event_feed.hpp"
#include "acquisition/http/http_server.hpp"
#include "acquisition/http/listen_address.hpp"
#include "acquisition/http/page.hpp"
#include "acquisition/job/control_loop.hpp"
#include "acquisition/job/job.hpp"
#include "acquisition/log.hpp"
#include "acquisition/records/sample_lock.hpp"
#include "acquisition/records/utc_time.hpp"
#include "acquisition/service/access.hpp"
#include "acquisition/service/api.hpp"
#include "acquisition/service/attempt_watch.hpp"
#include "acquisition/service/counted_stage.hpp"
#include "acquisition/service/device_wait.hpp"
#include "acquisition/service/devices.hpp"
#include "acquisition/service/event_source.hpp"
#include "acquisition/service/helping_threads.hpp"
#include "acquisition/service/liveness.hpp"
#include "acquisition/service/metrics/metrics_page.hpp"
#include "acquisition/service/metrics/run_metrics.hpp"
#include "acquisition/service/notifications/channels.hpp"
#include "acquisition/service/notifications/notifier.hpp"
#include "acquisition/service/notifications/run_watch.hpp"
#include "acquisition/service/service_manager.hpp"
#include "acquisition/service/spare_room.hpp"
#include "acquisition/service/status_json.hpp"
#include "acquisition/service/stop_signals.hpp"
#include "acquisition/service/watched_worker.hpp"
#include "acquisition/viewer/sample_api.hpp"
#include "reconstruct/sample/sample_folder.hpp"

namespace biotomy::acquisition {
namespace {

using std::chrono::milliseconds;
using std::chrono::steady_clock;

constexpr int kFailure = 1;
constexpr const char* kComponent = "daemon";
constexpr milliseconds kLook{200};     // between two looks of the main thread at the others
constexpr milliseconds kStopLook{50};  // the same while the rig is brought to rest
constexpr milliseconds kStopExtension{10000};
constexpr milliseconds kSignInterval{1000};
constexpr milliseconds kWorkerSlack{60000};
constexpr milliseconds kHung{5000};  // without a tick
constexpr int kCallsInATick = 8;     // to one device, each answered late, at most

ServiceDescription description_of(const Configuration& configuration) {
  return {.kind = ServiceDescription::Kind::rig,
          .reading_needs_token = configuration.service.access.reading_needs_token,
          .commands_need_token = true,
          .sample = configuration.job.plan.name,
          .neuroglancer = configuration.service.http.guard.neuroglancer_origin};
}

/// Longer than any task of the worker may take before the job itself faults.
milliseconds worker_limit(const JobSettings& job) {
  const SafetyLimits& limits = job.limits;
  return std::max({limits.preflight_limit, limits.store_limit, limits.assess_limit,
                   2 * job.camera.capture_time_out + limits.capture_limit}) +
         kWorkerSlack;
}

/// A tick that waits for devices which do not answer must not look like a hang.
void warn_of_short_watchdog(const ServiceManager& systemd, const Configuration& configuration) {
  const milliseconds longest_tick = kCallsInATick * configuration.stage.response_timeout +
                                    kCallsInATick * configuration.lines.response_timeout;
  const auto period = systemd.watchdog_period();
  if (!period || *period > longest_tick + kSignInterval) return;
  log_warning(kComponent,
              "systemd's WatchdogSec is not longer than devices that do not answer may "
              "hold up a tick, " +
                  std::to_string(longest_tick.count()) +
                  " ms: make it longer, or response_timeout_ms shorter");
}

/// Looks at each tick's status for whoever wants to know of it, in the control thread.
class Observers {
 public:
  explicit Observers(const Configuration& configuration)
      : plan_(configuration.job.plan),
        metrics_(configuration.service.tick),
        work_("the job " + plan_.name) {
    const NotifyConfiguration& notify = configuration.notify;
    if (!notify.is_on()) return;
    notifier_ = std::make_unique<Notifier>(notify.notifier, make_channels(notify));
    watch_.emplace(notify.watch, notifier_->interrupted(), std::chrono::system_clock::now);
  }

  void observe(const JobStatus& status, bool at_rest, TimePoint began) {
    metrics_.observe(status, began, steady_clock::now());
    if (!notifier_) return;
    if (at_rest_ != at_rest) {
      at_rest_ = at_rest;
      notifier_->work(at_rest ? ""
                              : work_ + ", since " + utc_text(std::chrono::system_clock::now()));
    }
    for (Notice& notice : watch_->observe(status, began)) notifier_->tell(std::move(notice));
  }

  /// Why it came to no first look. Who waits for a run that was interrupted should not wait in
  /// vain; who starts a daemon by hand sees for himself.
  void cannot_start(const std::string& why) {
    const bool has_started = at_rest_.has_value();
    if (!notifier_ || has_started || !notifier_->interrupted()) return;
    Notice notice;
    notice.kind = NoticeKind::interrupted;
    notice.text = "the daemon ended while the rig worked (" + *notifier_->interrupted() +
                  ") and cannot start again: " + why;
    notice.at = utc_text(std::chrono::system_clock::now());
    notice.job = plan_.name;
    notice.layers = plan_.layers;
    notifier_->tell_of_failed_start(notice);
  }

  const RunMetrics& metrics() const { return metrics_; }

  std::vector<Courier::Figures> couriers() const {
    return notifier_ ? notifier_->figures() : std::vector<Courier::Figures>{};
  }

 private:
  const JobPlan& plan_;
  RunMetrics metrics_;
  std::string work_;
  std::unique_ptr<Notifier> notifier_;
  std::optional<RunWatch> watch_;
  std::optional<bool> at_rest_;
};

/// What the control thread tells the main thread.
struct ControlState {
  std::atomic<bool> failed{false};
  std::atomic<bool> at_rest{true};
};

/// Passes the daemon's signs of life on to systemd, no more often than it needs them.
class SignsOfLife {
 public:
  SignsOfLife(Liveness& liveness, ServiceManager& systemd)
      : liveness_(liveness), systemd_(systemd) {}

  /// True when one was given now.
  bool give() {
    const auto now = steady_clock::now();
    if (now < next_ || !liveness_.take_progress(now)) return false;
    next_ = now + kSignInterval;
    systemd_.alive();
    return true;
  }

 private:
  Liveness& liveness_;
  ServiceManager& systemd_;
  TimePoint next_{};
};

/// Until a signal, or until the control loop has failed.
void watch_over(const StopSignals& signals, const ControlState& control, const Liveness& liveness,
                SignsOfLife& life, ServiceManager& systemd, const StatusBoard& board) {
  bool ready = false;
  bool complained = false;
  while (!control.failed && !signals.wait(ready ? kLook : kStopLook)) {
    if (!ready && liveness.ticks() > 0) {
      systemd.ready();
      ready = true;
    }
    if (ready) systemd.status(status_line(*board.look()));
    life.give();
    if (const auto complaint = liveness.complaint(steady_clock::now()); !complaint) {
      complained = false;
    } else if (!std::exchange(complained, true)) {
      log_error(kComponent, *complaint);
    }
  }
}

/// Asks the job to come to rest and waits for it. False when it did not within the limit.
bool bring_to_rest(const StopSignals& signals, const ControlState& control, SignsOfLife& life,
                   ServiceManager& systemd, const StatusBoard& board, OperatorDesk& desk,
                   milliseconds stop_limit) {
  auto reply = desk.post(OperatorCommand::shut_down, "");
  const auto limit = steady_clock::now() + stop_limit;
  while (!control.failed && steady_clock::now() < limit) {
    const bool heard = reply.wait_for(milliseconds(0)) == std::future_status::ready;
    if (heard && control.at_rest) return true;
    // As long as it parks it may park, up to its own limit; a hung daemon asks for no time.
    if (life.give()) systemd.extend(kStopExtension);
    systemd.status("stopping: " + status_line(*board.look()));
    signals.wait(kStopLook);
  }
  return false;
}

/// A thread that hangs cannot be waited for. The rig is left to the controller's watchdog, which
/// misses the heartbeat by then.
[[noreturn]] void end_at_once(const char* why) {
  log_error(kComponent, std::string(why) + ": ends without it");
  std::_Exit(kFailure);
}

void end_if_control_hangs(const Liveness& liveness) {
  const std::uint64_t before = liveness.ticks();
  const auto limit = steady_clock::now() + kHung;
  while (liveness.ticks() == before) {
    if (steady_clock::now() > limit) end_at_once("the control loop hangs");
    std::this_thread::sleep_for(kStopLook);
  }
}

/// Until a signal or a failure ends it. The program's exit code.
int run_rig(const Configuration& configuration, const StopSignals& signals, ServiceManager& systemd,
            Observers& observers) {
  const JobPlan& plan = configuration.job.plan;
  const std::filesystem::path journal = plan.sample / reconstruct::SampleFolder::kJournalName;
  DeviceWait wait(configuration.service.device_wait, systemd, steady_clock::now,
                  [&](milliseconds time) { return signals.wait(time); });
  const Devices devices = await_devices(configuration, wait);
  if (!devices.are_all_there()) return 0;
  WatchedCamera watched_camera(*devices.camera, std::chrono::system_clock::now);
  CorrectedCamera camera(watched_camera, configuration.job.calibration);
  LinkCounts link;
  CountedStage stage(*devices.stage, link);

  ThreadWorker worker_thread;
  WatchedWorker worker(worker_thread, steady_clock::now);
  ThreadWorker volume_worker;
  ThreadWorker event_worker;
  OperatorDesk desk;
  StatusBoard board;
  Access access(Credentials::read_or_make(configuration.service.token_file),
                configuration.service.access, steady_clock::now, [&](const std::string& line) {
                  log_warning("access", line);
                  desk.remark(line);
                });
  Job job(configuration.job,
          {stage, *devices.lines, camera, worker, volume_worker, event_worker, desk, board,
           &watched_camera, &watched_camera},
          real_surroundings(),
          take_over_earlier_run(plan.sample, utc_text(std::chrono::system_clock::now())));
  AttemptWatch attempts(journal);
  const auto status = [&] {
    return status_json(*board.look(), {configuration.job.limits, attempts.last()});
  };
  const Page page(page_assets());
  EventFeed feed;
  ViewerSettings viewer = configuration.service.viewer;
  viewer.bytes_to_spare = [&, folder = viewer.exports.empty() ? plan.sample.parent_path()
                                                              : viewer.exports] {
    return bytes_to_spare(folder, plan.sample, *board.look(), configuration.job.limits);
  };
  SampleApi sample(plan.sample, viewer);
  sample.on_export([&feed](const std::string& json) { tell_export(feed, json); });
  const EventSource events(feed, {status, [&] { return sample.sample_event(); }, &attempts});
  const Api api(
      {desk, access, page, sample, feed, journal, description_of(configuration), status, [&] {
         return metrics_page(*board.look(), observers.metrics(), link, observers.couriers());
       }});
  const HttpServer server(api, configuration.service.host, configuration.service.port,
                          configuration.service.http);

  Liveness liveness([&] { return worker.busy_since(); }, worker_limit(configuration.job));
  SignsOfLife life(liveness, systemd);
  ControlState control;
  bool came_to_rest = false;
  {
    const ControlLoop loop(
        configuration.service.tick,
        [&](TimePoint now) {
          if (liveness.ticks() == 0) ::pthread_setname_np(::pthread_self(), "control");
          job.tick(now);
          control.at_rest = job.at_rest();
          observers.observe(*board.look(), control.at_rest, now);
          liveness.ticked();
        },
        [&](const char* what) {
          log_error(kComponent, std::string("the control loop failed: ") + what);
          control.failed = true;
        });
    log_info(kComponent, "listening on " + http_url(configuration.service.host, server.port()));
    watch_over(signals, control, liveness, life, systemd, board);
    log_info(kComponent, "is ending: brings the rig to rest");
    systemd.stopping();
    systemd.extend(kStopExtension);
    came_to_rest = bring_to_rest(signals, control, life, systemd, board, desk,
                                 configuration.service.stop_limit);
    if (!came_to_rest && !control.failed) end_if_control_hangs(liveness);
  }
  if (!came_to_rest) job.halt(steady_clock::now());
  if (liveness.complaint(steady_clock::now())) end_at_once("the thread for camera and disk hangs");
  return control.failed ? kFailure : 0;
}

}  // namespace

int run_daemon(const Configuration& configuration) {
  const StopSignals signals;
  start_helping_threads();
  ServiceManager systemd;
  warn_of_short_watchdog(systemd, configuration);
  const SampleLock lock(configuration.job.plan.sample);
  Observers observers(configuration);
  try {
    return run_rig(configuration, signals, systemd, observers);
  } catch (const std::exception& failure) {
    observers.cannot_start(failure.what());
    throw;
  }
}

int test_notification(const Configuration& configuration) {
  const StopSignals signals;
  const NotifyConfiguration& notify = configuration.notify;
  if (!notify.is_on()) {
    std::cerr << "biotomyd: there is nobody to tell: set notify.command or notify.webhook\n";
    return kFailure;
  }
  Notice notice;
  notice.text = "a test: notifications of this rig reach you";
  notice.at = utc_text(std::chrono::system_clock::now());
  notice.job = configuration.job.plan.name;
  notice.layers = configuration.job.plan.layers;
  bool failed = false;
  for (const std::unique_ptr<Channel>& channel : make_channels(notify)) {
    try {
      channel->deliver(notice_json(notice, "test"), notify.notifier.courier.time_out, {});
      std::cout << channel->name() << ": delivered\n";
    } catch (const DeliveryError& error) {
      std::cerr << "biotomyd: " << channel->name() << ": " << error.what() << '\n';
      failed = true;
    }
  }
  return failed ? kFailure : 0;
}

}  // namespace biotomy::acquisition
