#include "reconstruct/bricks/brick_cache.hpp"

#include <exception>
#include <future>
#include <map>
#include <mutex>

#include "reconstruct/store/lru_map.hpp"

namespace biotomy::reconstruct {
namespace {

constexpr std::size_t kFillWeight = 64;  // a remembered "nothing there" is not free either

}  // namespace

struct BrickCache::State {
  std::size_t capacity_bytes;
  std::size_t brick_bytes;
  Fetch fetch;
  mutable std::mutex mutex;
  LruMap<BrickKey, TexelBrick> bricks;
  std::map<BrickKey, std::shared_future<TexelBrick>> being_fetched;

  State(std::size_t capacity, std::size_t bytes, Fetch function)
      : capacity_bytes(capacity),
        brick_bytes(bytes),
        fetch(std::move(function)),
        bricks(capacity) {}

  /// What a caller has to fetch, the promises to those who wait for it meanwhile, and what others
  /// fetch already.
  struct Work {
    std::vector<ChunkIndex> indices;
    std::vector<std::size_t> places;  // of the indices in the caller's order
    std::vector<std::promise<TexelBrick>> promises;
    std::vector<std::pair<std::size_t, std::shared_future<TexelBrick>>> awaited;
  };

  Work divide(int level, std::span<const ChunkIndex> wanted, std::vector<TexelBrick>& found) {
    Work work;
    const std::lock_guard lock(mutex);
    for (std::size_t i = 0; i < wanted.size(); ++i) {
      const BrickKey key{level, wanted[i]};
      if (const TexelBrick* brick = bricks.find(key); brick != nullptr) {
        found[i] = *brick;
      } else if (const auto other = being_fetched.find(key); other != being_fetched.end()) {
        work.awaited.emplace_back(i, other->second);
      } else {
        work.indices.push_back(wanted[i]);
        work.places.push_back(i);
        being_fetched.emplace(key, work.promises.emplace_back().get_future().share());
      }
    }
    return work;
  }

  void keep(int level, const Work& work, const std::vector<TexelBrick>& fetched) {
    const std::lock_guard lock(mutex);
    for (std::size_t i = 0; i < fetched.size(); ++i) {
      const BrickKey key{level, work.indices[i]};
      bricks.put(key, fetched[i], fetched[i] ? brick_bytes : kFillWeight);
      being_fetched.erase(key);
    }
  }

  void give_up(int level, const Work& work) {
    const std::lock_guard lock(mutex);
    for (const ChunkIndex& index : work.indices) {
      being_fetched.erase({level, index});
    }
  }
};

BrickCache::BrickCache(std::size_t capacity_bytes, std::size_t brick_bytes, Fetch fetch)
    : state_(std::make_unique<State>(capacity_bytes, brick_bytes, std::move(fetch))) {}

BrickCache::~BrickCache() = default;

std::size_t BrickCache::capacity_bytes() const {
  return state_->capacity_bytes;
}

std::vector<TexelBrick> BrickCache::get(int level, std::span<const ChunkIndex> wanted) {
  std::vector<TexelBrick> bricks(wanted.size());
  State::Work work = state_->divide(level, wanted, bricks);
  if (!work.indices.empty()) {
    // Without the lock; those who ask meanwhile wait for the promises.
    try {
      const std::vector<TexelBrick> fetched = state_->fetch(level, work.indices);
      state_->keep(level, work, fetched);
      for (std::size_t i = 0; i < fetched.size(); ++i) {
        bricks[work.places[i]] = fetched[i];
        work.promises[i].set_value(fetched[i]);
      }
    } catch (...) {
      state_->give_up(level, work);
      for (std::promise<TexelBrick>& promise : work.promises) {
        promise.set_exception(std::current_exception());
      }
      throw;
    }
  }
  for (const auto& [place, brick] : work.awaited) {
    bricks[place] = brick.get();
  }
  return bricks;
}

std::vector<ChunkIndex> BrickCache::missing(int level, std::span<const ChunkIndex> indices) const {
  std::vector<ChunkIndex> result;
  const std::lock_guard lock(state_->mutex);
  for (const ChunkIndex& index : indices) {
    const BrickKey key{level, index};
    if (state_->bricks.find(key) == nullptr && !state_->being_fetched.contains(key)) {
      result.push_back(index);
    }
  }
  return result;
}

void BrickCache::adopt(const BrickCache& other,
                       const std::function<bool(const BrickKey&)>& wanted) {
  const std::scoped_lock lock(state_->mutex, other.state_->mutex);
  other.state_->bricks.visit([&](const BrickKey& key, const TexelBrick& brick, std::size_t weight) {
    if (wanted(key)) {
      state_->bricks.put(key, brick, weight);
    }
  });
}

}  // namespace biotomy::reconstruct
