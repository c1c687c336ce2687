#include "reconstruct/bricks/brick_cache.hpp"

#include <exception>
#include <future>
#include <map>
#include <mutex>
#include <numeric>

#include <oneapi/tbb/task_arena.h>

#include "reconstruct/store/lru_map.hpp"

namespace biotomy::reconstruct {
namespace {

constexpr std::size_t kFillWeight = 64;  // a remembered "nothing there" is not free either

bool holds(const KeptBrick& brick, CellSet cells) {
  return brick == nullptr || brick->holds(cells);
}

TexelBrick texels_of(const KeptBrick& brick) {
  return brick == nullptr ? nullptr : TexelBrick(brick, brick->texels());
}

}  // namespace

struct BrickCache::State {
  std::size_t capacity_bytes;
  std::size_t brick_bytes;
  Fetch fetch;
  mutable std::mutex mutex;
  LruMap<BrickKey, KeptBrick> bricks;
  std::map<BrickKey, std::shared_future<KeptBrick>> being_fetched;

  State(std::size_t capacity, std::size_t bytes, Fetch function)
      : capacity_bytes(capacity),
        brick_bytes(bytes),
        fetch(std::move(function)),
        bricks(capacity) {}

  /// What a caller has to fetch, the promises to those who wait for it meanwhile, and what others
  /// fetch already.
  struct Work {
    std::vector<BrickFetch> fetches;
    std::vector<std::size_t> places;  // of the fetches in the caller's order
    std::vector<std::promise<KeptBrick>> promises;
    std::vector<std::pair<std::size_t, std::shared_future<KeptBrick>>> awaited;
  };

  /// Of those of `wanted` that stand at `open`.
  Work divide(int level, std::span<const BrickPart> wanted, std::span<const std::size_t> open,
              std::vector<TexelBrick>& found) {
    Work work;
    const std::lock_guard lock(mutex);
    for (const std::size_t i : open) {
      const BrickPart& part = wanted[i];
      const BrickKey key{level, part.index};
      const KeptBrick* const kept = bricks.find(key);
      if (kept != nullptr && holds(*kept, part.cells)) {
        found[i] = texels_of(*kept);
      } else if (const auto other = being_fetched.find(key); other != being_fetched.end()) {
        work.awaited.emplace_back(i, other->second);
      } else {
        work.fetches.push_back({part, kept != nullptr ? *kept : nullptr});
        work.places.push_back(i);
        being_fetched.emplace(key, work.promises.emplace_back().get_future().share());
      }
    }
    return work;
  }

  void keep(int level, const Work& work, const std::vector<KeptBrick>& fetched) {
    const std::lock_guard lock(mutex);
    for (std::size_t i = 0; i < fetched.size(); ++i) {
      const BrickKey key{level, work.fetches[i].part.index};
      bricks.put(key, fetched[i], fetched[i] ? brick_bytes : kFillWeight);
      being_fetched.erase(key);
    }
  }

  void give_up(int level, const Work& work) {
    const std::lock_guard lock(mutex);
    for (const BrickFetch& each : work.fetches) {
      being_fetched.erase({level, each.part.index});
    }
  }

  /// Without the lock; those who ask meanwhile wait for the promises.
  void carry_out(int level, Work& work, std::vector<TexelBrick>& found) {
    if (work.fetches.empty()) {
      return;
    }
    try {
      // Isolated, as a thread that waits for parts of this may otherwise take up another asker's
      // work, and wait in there for the promises that it has yet to keep itself.
      const std::vector<KeptBrick> fetched =
          tbb::this_task_arena::isolate([&] { return fetch(level, work.fetches); });
      keep(level, work, fetched);
      for (std::size_t i = 0; i < fetched.size(); ++i) {
        found[work.places[i]] = texels_of(fetched[i]);
        work.promises[i].set_value(fetched[i]);
      }
    } catch (...) {
      give_up(level, work);
      for (std::promise<KeptBrick>& promise : work.promises) {
        promise.set_exception(std::current_exception());
      }
      throw;
    }
  }
};

BrickCache::BrickCache(std::size_t capacity_bytes, std::size_t brick_bytes, Fetch fetch)
    : state_(std::make_unique<State>(capacity_bytes, brick_bytes, std::move(fetch))) {}

BrickCache::~BrickCache() = default;

std::size_t BrickCache::capacity_bytes() const {
  return state_->capacity_bytes;
}

std::vector<TexelBrick> BrickCache::get(int level, std::span<const BrickPart> wanted) {
  std::vector<TexelBrick> bricks(wanted.size());
  std::vector<std::size_t> open(wanted.size());
  std::iota(open.begin(), open.end(), std::size_t{0});
  while (!open.empty()) {
    State::Work work = state_->divide(level, wanted, open, bricks);
    state_->carry_out(level, work, bricks);
    open.clear();
    for (const auto& [place, fetched] : work.awaited) {
      const KeptBrick& brick = fetched.get();
      if (holds(brick, wanted[place].cells)) {
        bricks[place] = texels_of(brick);
      } else {
        open.push_back(place);  // who fetched it needed other cells
      }
    }
  }
  return bricks;
}

std::vector<ChunkIndex> BrickCache::missing(int level, std::span<const BrickPart> wanted) const {
  std::vector<ChunkIndex> result;
  const std::lock_guard lock(state_->mutex);
  for (const BrickPart& part : wanted) {
    const BrickKey key{level, part.index};
    const KeptBrick* const kept = state_->bricks.find(key);
    const bool is_there = kept != nullptr && holds(*kept, part.cells);
    if (!is_there && !state_->being_fetched.contains(key)) {
      result.push_back(part.index);
    }
  }
  return result;
}

void BrickCache::adopt(const BrickCache& other,
                       const std::function<bool(const BrickKey&)>& wanted) {
  const std::scoped_lock lock(state_->mutex, other.state_->mutex);
  other.state_->bricks.visit([&](const BrickKey& key, const KeptBrick& brick, std::size_t weight) {
    if (wanted(key)) {
      state_->bricks.put(key, brick, weight);
    }
  });
}

}  // namespace biotomy::reconstruct
