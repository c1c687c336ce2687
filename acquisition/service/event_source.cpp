#include "acquisition/service/event_source.hpp"

#include <exception>
#include <utility>

#include <nlohmann/json.hpp>
#include <pthread.h>

#include "acquisition/log.hpp"
#include "acquisition/viewer/attempt_document.hpp"

namespace biotomy::acquisition {
namespace {

constexpr std::chrono::milliseconds kLook{200};
constexpr int kLooksAtSample = 3;          // of which it takes one: files are looked at for it
constexpr std::chrono::seconds kAlive{5};  // between signs of life, however long a look takes

}  // namespace

EventSource::EventSource(EventFeed& feed, EventSights sights, Clock clock)
    : feed_(feed), sights_(std::move(sights)), clock_(std::move(clock)) {
  if (sights_.attempts != nullptr) {
    const auto known = sights_.attempts->last();
    feed_.begin_after(known ? known->id : 0);
  }
  records_ = std::jthread([this](const std::stop_token& stop) { watch_records(stop); });
  rig_ = std::jthread([this](const std::stop_token& stop) { watch_rig(stop); });
}

EventSource::~EventSource() {
  rig_.request_stop();
  records_.request_stop();
}

void EventSource::watch_rig(const std::stop_token& stop) {
  auto alive = clock_();
  look_on("events", stop, [&] {
    if (const auto now = clock_(); now - alive >= kAlive) {
      alive = now;
      feed_.tell_alive();
    }
    tell_state(sights_.status, "status", told_status_);
  });
}

void EventSource::watch_records(const std::stop_token& stop) {
  int look = 0;
  look_on("events-disk", stop, [&] {
    tell_attempts();
    if (look++ % kLooksAtSample == 0) tell_state(sights_.sample, "sample", told_sample_);
  });
}

void EventSource::look_on(const char* name, const std::stop_token& stop,
                          const std::function<void()>& look) {
  ::pthread_setname_np(::pthread_self(), name);
  std::string complaint;  // the last that was logged
  while (!stop.stop_requested()) {
    try {
      look();
      complaint.clear();
    } catch (const std::exception& error) {
      // A journal that is locked or being made: the next look may see it.
      if (complaint != error.what()) log_warning("events", error.what());
      complaint = error.what();
    }
    std::unique_lock lock(mutex_);
    woken_.wait_for(lock, stop, kLook, [] { return false; });
  }
}

void EventSource::tell_state(const std::function<std::string()>& sight, const char* name,
                             std::string& told) {
  if (!sight) return;
  std::string seen = sight();
  if (seen == told) return;
  feed_.tell_state(name, name, seen);
  told = std::move(seen);
}

void EventSource::tell_attempts() {
  if (sights_.attempts == nullptr) return;
  for (const AttemptNote& attempt : sights_.attempts->look()) {
    feed_.tell(attempt.id, attempt_event(attempt));
  }
}

EventText attempt_event(const AttemptNote& attempt) {
  using nlohmann::ordered_json;
  const std::string json =
      attempt_document(attempt).dump(-1, ' ', false, ordered_json::error_handler_t::replace);
  return event_text("attempt", json, attempt.id);
}

void tell_export(EventFeed& feed, const std::string& json) {
  const nlohmann::json document = nlohmann::json::parse(json, nullptr, false);
  if (!document.is_object() || !document.contains("id")) return;
  feed.tell_state("export " + document["id"].dump(), "export", json, EventFeed::AtOnce::no);
}

}  // namespace biotomy::acquisition
