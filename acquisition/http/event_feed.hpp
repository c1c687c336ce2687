#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

namespace biotomy::acquisition {

/// A server-sent event as it is written; all who hear it share it.
using EventText = std::shared_ptr<const std::string>;

/// "event: …", "data: …" and, where it has one, "id: …"; `json` is one line.
EventText event_text(const std::string& name, const std::string& json,
                     std::optional<std::int64_t> id = {});

/// Says nothing but after which numbered event a listener goes on: whoever hears no other before
/// the connection is lost asks for those after it.
EventText place_text(std::int64_t id);

/// What one listener has not heard yet: of a state only the latest, of numbered events each, but no
/// more than a thousand; who misses more is told `reload` instead, with the id of the last one that
/// it stands for. Safe for many threads.
class EventSubscription {
 public:
  /// What waits, in order; nothing afterwards.
  std::vector<EventText> take();

  /// `wake` is called when something waits again, after `take` left nothing; it must not block, and
  /// is not called any more once this was given another, or none.
  void on_event(std::function<void()> wake);

  /// The last numbered event that was told to all before this began.
  std::int64_t begins_after() const { return begins_after_; }

  /// Numbered events of before it began, to be heard first.
  void catch_up(const std::vector<EventText>& missed);

 private:
  friend class EventFeed;
  struct Waiting {
    std::string key;  ///< of the state that it tells; empty for a numbered event
    EventText text;
  };
  void put(const std::string& key, const EventText& text);
  void put_each(std::int64_t id, const EventText& text);
  void woken(bool was_empty) const;

  mutable std::mutex mutex_;
  std::deque<Waiting> waiting_;
  std::size_t numbered_ = 0;
  std::int64_t begins_after_ = 0;
  std::function<void()> wake_;
};

/// Tells many listeners what happens. Each event is made into text once, whoever hears it. Safe for
/// many threads.
class EventFeed {
 public:
  /// Whether a state is told to whoever begins to listen.
  enum class AtOnce { yes, no };

  /// A state: what was told under `key` and not heard yet is replaced by it.
  void tell_state(const std::string& key, const std::string& name, const std::string& json,
                  AtOnce at_once = AtOnce::yes);

  /// Something that everybody is to hear, with its id; ids grow.
  void tell(std::int64_t id, const EventText& text);

  /// Numbered events up to this one are counted as told.
  void begin_after(std::int64_t id);

  /// A line that says nothing, so that listeners know that the connection lives.
  void tell_alive();

  std::shared_ptr<EventSubscription> subscribe();

  std::size_t listeners() const;

 private:
  template <typename Tell>
  void to_each(Tell tell);

  mutable std::mutex mutex_;
  std::map<std::string, EventText> states_;  ///< by their keys
  std::int64_t last_id_ = 0;
  std::vector<std::weak_ptr<EventSubscription>> listeners_;
};

}  // namespace biotomy::acquisition
