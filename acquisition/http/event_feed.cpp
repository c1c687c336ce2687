#include "acquisition/http/event_feed.hpp"

#include <algorithm>
#include <utility>

namespace biotomy::acquisition {
namespace {

constexpr std::size_t kMostNumbered = 1000;
constexpr const char* kAlive = "alive";

EventText shared(std::string text) {
  return std::make_shared<const std::string>(std::move(text));
}

}  // namespace

EventText event_text(const std::string& name, const std::string& json,
                     std::optional<std::int64_t> id) {
  const std::string number = id ? "id: " + std::to_string(*id) + "\n" : "";
  return shared(number + "event: " + name + "\ndata: " + json + "\n\n");
}

EventText place_text(std::int64_t id) {
  return shared("id: " + std::to_string(id) + "\n\n");
}

std::vector<EventText> EventSubscription::take() {
  const std::scoped_lock lock(mutex_);
  std::vector<EventText> taken;
  taken.reserve(waiting_.size());
  for (Waiting& entry : waiting_) taken.push_back(std::move(entry.text));
  waiting_.clear();
  numbered_ = 0;
  return taken;
}

void EventSubscription::on_event(std::function<void()> wake) {
  const std::scoped_lock lock(mutex_);
  wake_ = std::move(wake);
}

void EventSubscription::catch_up(const std::vector<EventText>& missed) {
  const std::scoped_lock lock(mutex_);
  const bool was_empty = waiting_.empty();
  for (auto text = missed.rbegin(); text != missed.rend(); ++text) {
    waiting_.push_front({.key = {}, .text = *text});
  }
  numbered_ += missed.size();
  woken(was_empty);
}

void EventSubscription::put(const std::string& key, const EventText& text) {
  const std::scoped_lock lock(mutex_);
  const bool was_empty = waiting_.empty();
  const auto same = std::find_if(waiting_.begin(), waiting_.end(),
                                 [&](const Waiting& entry) { return entry.key == key; });
  if (same != waiting_.end()) {
    same->text = text;
  } else {
    waiting_.push_back({.key = key, .text = text});
  }
  woken(was_empty);
}

void EventSubscription::put_each(std::int64_t id, const EventText& text) {
  const std::scoped_lock lock(mutex_);
  const bool was_empty = waiting_.empty();
  if (numbered_ < kMostNumbered) {
    waiting_.push_back({.key = {}, .text = text});
    ++numbered_;
  } else {
    std::erase_if(waiting_, [](const Waiting& entry) { return entry.key.empty(); });
    waiting_.push_back({.key = {}, .text = event_text("reload", "{}", id)});
    numbered_ = 1;
  }
  woken(was_empty);
}

void EventSubscription::woken(bool was_empty) const {
  if (was_empty && !waiting_.empty() && wake_) wake_();
}

void EventFeed::tell_state(const std::string& key, const std::string& name, const std::string& json,
                           AtOnce at_once) {
  const EventText text = event_text(name, json);
  const std::scoped_lock lock(mutex_);
  if (at_once == AtOnce::yes) states_[key] = text;
  to_each([&](EventSubscription& listener) { listener.put(key, text); });
}

void EventFeed::tell(std::int64_t id, const EventText& text) {
  const std::scoped_lock lock(mutex_);
  last_id_ = id;
  to_each([&](EventSubscription& listener) { listener.put_each(id, text); });
}

void EventFeed::begin_after(std::int64_t id) {
  const std::scoped_lock lock(mutex_);
  last_id_ = id;
}

void EventFeed::tell_alive() {
  const EventText text = shared(": \n\n");
  const std::scoped_lock lock(mutex_);
  to_each([&](EventSubscription& listener) { listener.put(kAlive, text); });
}

std::shared_ptr<EventSubscription> EventFeed::subscribe() {
  auto subscription = std::make_shared<EventSubscription>();
  const std::scoped_lock lock(mutex_);
  subscription->begins_after_ = last_id_;
  for (const auto& [key, text] : states_) subscription->put(key, text);
  listeners_.push_back(subscription);
  return subscription;
}

std::size_t EventFeed::listeners() const {
  const std::scoped_lock lock(mutex_);
  return static_cast<std::size_t>(
      std::count_if(listeners_.begin(), listeners_.end(),
                    [](const auto& listener) { return !listener.expired(); }));
}

/// Under the lock, so that all hear in one order.
template <typename Tell>
void EventFeed::to_each(Tell tell) {
  std::erase_if(listeners_, [&](const std::weak_ptr<EventSubscription>& entry) {
    const std::shared_ptr<EventSubscription> listener = entry.lock();
    if (listener) tell(*listener);
    return !listener;
  });
}

}  // namespace biotomy::acquisition
