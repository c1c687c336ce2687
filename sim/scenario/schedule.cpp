#include "sim/scenario/schedule.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "sim/phantom/gradient_noise.hpp"

namespace biotomy::sim {

namespace {

/// A number for a name that is the same on every machine (FNV-1a, 64 bits).
std::uint64_t number_of(const std::string& name) {
  std::uint64_t number = 0xcbf29ce484222325;
  for (const char c : name) {
    number = (number ^ static_cast<unsigned char>(c)) * 0x100000001b3;
  }
  return number;
}

}  // namespace

Schedule::Schedule(const Scenario& scenario, std::uint64_t seed, ScheduleEvents events)
    : seed_(seed), events_(std::move(events)) {
  for (const ScenarioEvent& event : scenario.events) {
    entries_.push_back({.event = event, .next = event.when.at});
  }
}

void Schedule::advance(double rig_s, RealTime now) {
  rig_s_ = rig_s;
  now_ = now;
  for (Entry& entry : entries_) {
    if (!entry.since_s) continue;
    const Duration& lasts = entry.event.lasts;
    const bool over =
        (lasts.rig_seconds && rig_s - *entry.since_s >= *lasts.rig_seconds) ||
        (lasts.real_seconds &&
         std::chrono::duration<double>(now - entry.since).count() >= *lasts.real_seconds);
    if (over) end(entry);
  }
  reached(Occasion::Moment::rig_time, rig_s);
  for (Entry& entry : entries_) {
    if (std::erase_if(entry.due_s, [&](double due) { return due <= rig_s; }) > 0) {
      begin(entry);
    }
  }
}

void Schedule::grind_started(std::uint32_t layer) {
  reached(Occasion::Moment::grind_started, layer);
}

void Schedule::grind_ended(std::uint32_t layer, bool done) {
  for (Entry& entry : entries_) {
    if (entry.since_s) ++entry.grinds;
  }
  end_if([](const Entry& e) { return e.event.lasts.grinds && e.grinds >= *e.event.lasts.grinds; });
  if (done) {
    reached(Occasion::Moment::grind_finished, layer);
  }
}

void Schedule::capture_begins() {
  reached(Occasion::Moment::capture, ++captures_);
  for (Entry& entry : entries_) {
    if (entry.since_s) ++entry.captures;
  }
}

void Schedule::capture_ends() {
  end_if([](const Entry& e) {
    return e.event.lasts.captures && e.captures >= *e.event.lasts.captures;
  });
}

void Schedule::camera_failed() {
  for (Entry& entry : entries_) {
    if (entry.since_s) ++entry.captures;
  }
  capture_ends();
}

void Schedule::reset_given() {
  end_if([](const Entry& e) { return e.event.lasts.until_reset; });
}

void Schedule::add(const ScenarioEvent& event) {
  remove(event.name);
  entries_.push_back({.event = event, .next = event.when.at});
  reached(Occasion::Moment::rig_time, rig_s_);
}

bool Schedule::remove(const std::string& name) {
  const auto entry = std::ranges::find(entries_, name, [](const Entry& e) { return e.event.name; });
  if (entry == entries_.end()) {
    return false;
  }
  if (entry->since_s) end(*entry);
  entries_.erase(entry);
  return true;
}

/// Lets every event that waits for this moment come up. A layer that was ground before the twin
/// started is over; rig time is never missed.
void Schedule::reached(Occasion::Moment moment, double value) {
  for (Entry& entry : entries_) {
    const Occasion& when = entry.event.when;
    if (when.moment != moment || value < entry.next) continue;
    const bool is_time = moment == Occasion::Moment::rig_time;
    const double behind = when.every > 0.0 ? std::floor((value - when.at) / when.every) : 0.0;
    const double latest = when.at + behind * when.every;
    entry.next = when.every > 0.0 ? latest + when.every : kNever;
    if ((is_time || latest == value) && drawn(entry, latest)) {
      if (when.delay_s > 0.0) {
        entry.due_s.push_back(rig_s_ + when.delay_s);
      } else {
        begin(entry);
      }
    }
  }
}

bool Schedule::drawn(const Entry& entry, double value) const {
  const auto occasion = static_cast<std::uint64_t>(std::llround(1e3 * value));
  return mixed_fraction(seed_ ^ number_of(entry.event.name), occasion) <
         static_cast<float>(entry.event.when.probability);
}

void Schedule::begin(Entry& entry) {
  if (entry.since_s) return;
  entry.since_s = rig_s_;
  entry.since = now_;
  entry.captures = 0;
  entry.grinds = 0;
  note_active();
  events_.began(entry.event);
}

void Schedule::end(Entry& entry) {
  entry.since_s.reset();
  note_active();
  events_.ended(entry.event);
}

void Schedule::end_if(bool (*over)(const Entry&)) {
  for (Entry& entry : entries_) {
    if (entry.since_s && over(entry)) end(entry);
  }
}

void Schedule::note_active() {
  active_.clear();
  for (const Entry& entry : entries_) {
    if (entry.since_s) active_.push_back({entry.event.fault, *entry.since_s});
  }
}

}  // namespace biotomy::sim
