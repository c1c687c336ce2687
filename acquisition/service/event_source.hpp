#pragma once

#include <chrono>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <stop_token>
#include <string>
#include <thread>

#include "acquisition/http/event_feed.hpp"
#include "acquisition/records/journal_rows.hpp"
#include "acquisition/service/attempt_watch.hpp"

namespace biotomy::acquisition {

/// What an EventSource looks at. Each may be empty, and is called by one thread of the source
/// alone.
struct EventSights {
  std::function<std::string()> status;  ///< the JSON of the event `status`
  std::function<std::string()> sample;  ///< the JSON of the event `sample`
  AttemptWatch* attempts = nullptr;
};

/// Looks at the rig and the sample five times a second and tells a feed what has changed. Nobody
/// waits for it: not the control thread, whose status it only looks at. The rig has a thread of its
/// own that touches no file: a disk that does not answer keeps nobody from hearing of an alarm.
class EventSource {
 public:
  using Clock = std::function<std::chrono::steady_clock::time_point()>;

  /// All outlive it.
  EventSource(EventFeed& feed, EventSights sights, Clock clock = std::chrono::steady_clock::now);
  ~EventSource();
  EventSource(const EventSource&) = delete;
  EventSource& operator=(const EventSource&) = delete;

 private:
  void watch_rig(const std::stop_token& stop);
  void watch_records(const std::stop_token& stop);
  void look_on(const char* name, const std::stop_token& stop, const std::function<void()>& look);
  void tell_state(const std::function<std::string()>& sight, const char* name, std::string& told);
  void tell_attempts();

  EventFeed& feed_;
  EventSights sights_;
  Clock clock_;
  std::string told_status_;
  std::string told_sample_;
  std::mutex mutex_;
  std::condition_variable_any woken_;
  std::jthread records_;
  std::jthread rig_;
};

/// The event `attempt`.
EventText attempt_event(const AttemptNote& attempt);

/// Tells a feed that an export has changed; `json` is the export's.
void tell_export(EventFeed& feed, const std::string& json);

}  // namespace biotomy::acquisition
