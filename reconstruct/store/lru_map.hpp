#pragma once

#include <cstddef>
#include <iterator>
#include <list>
#include <map>
#include <utility>

namespace biotomy::reconstruct {

/// Keeps values up to a total weight; the longest unused go first, but never the one put in last.
/// Not for two threads at once.
template <typename Key, typename Value>
class LruMap {
 public:
  explicit LruMap(std::size_t capacity) : capacity_(capacity) {}

  /// Null when the key is not there; otherwise it is the last used now.
  Value* find(const Key& key) {
    const auto found = places_.find(key);
    if (found == places_.end()) {
      return nullptr;
    }
    entries_.splice(entries_.begin(), entries_, found->second);
    return &entries_.front().value;
  }

  /// Replaces a value of the same key.
  void put(const Key& key, Value value, std::size_t weight) {
    if (const auto found = places_.find(key); found != places_.end()) {
      remove(found->second);
    }
    entries_.push_front({key, std::move(value), weight});
    places_[key] = entries_.begin();
    weight_ += weight;
    while (weight_ > capacity_ && entries_.size() > 1) {
      remove(std::prev(entries_.end()));
    }
  }

  /// Calls visit(key, value, weight) for all, the longest unused first.
  template <typename Visit>
  void visit(Visit visit) const {
    for (auto entry = entries_.rbegin(); entry != entries_.rend(); ++entry) {
      visit(entry->key, entry->value, entry->weight);
    }
  }

 private:
  struct Entry {
    Key key;
    Value value;
    std::size_t weight;
  };
  using Place = typename std::list<Entry>::iterator;

  void remove(Place place) {
    weight_ -= place->weight;
    places_.erase(place->key);
    entries_.erase(place);
  }

  std::size_t capacity_;
  std::size_t weight_ = 0;
  std::list<Entry> entries_;  // the last used in front
  std::map<Key, Place> places_;
};

}  // namespace biotomy::reconstruct
