#include "reconstruct/store/chunk_cache.hpp"

#include <future>
#include <map>
#include <mutex>
#include <utility>

#include "reconstruct/store/lru_map.hpp"

namespace biotomy::reconstruct {
namespace {

using Chunk = std::shared_ptr<const ChunkVoxels>;

constexpr std::size_t kFillWeight = 64;  // a remembered "nothing there" is not free either

}  // namespace

struct ChunkCache::State {
  const Volume& volume;
  std::mutex mutex;
  LruMap<ChunkIndex, Chunk> decoded;
  std::map<ChunkIndex, std::shared_future<Chunk>> being_decoded;

  State(const Volume& source, std::size_t capacity_bytes)
      : volume(source), decoded(capacity_bytes) {}
};

ChunkCache::ChunkCache(const Volume& volume, std::size_t capacity_bytes)
    : state_(std::make_unique<State>(volume, capacity_bytes)) {}

ChunkCache::~ChunkCache() = default;

Chunk ChunkCache::get(ChunkIndex index) {
  std::promise<Chunk> promise;
  {
    std::unique_lock lock(state_->mutex);
    if (const Chunk* found = state_->decoded.find(index); found != nullptr) {
      return *found;
    }
    if (const auto found = state_->being_decoded.find(index);
        found != state_->being_decoded.end()) {
      const std::shared_future<Chunk> other = found->second;
      lock.unlock();
      return other.get();
    }
    state_->being_decoded.emplace(index, promise.get_future().share());
  }
  // Read and decoded without the lock; those who ask meanwhile wait for the promise.
  try {
    Chunk chunk = state_->volume.read_chunk(0, index);
    {
      const std::lock_guard lock(state_->mutex);
      state_->decoded.put(index, chunk, chunk ? chunk->size() : kFillWeight);
      state_->being_decoded.erase(index);
    }
    promise.set_value(chunk);
    return chunk;
  } catch (...) {
    {
      const std::lock_guard lock(state_->mutex);
      state_->being_decoded.erase(index);
    }
    promise.set_exception(std::current_exception());
    throw;
  }
}

}  // namespace biotomy::reconstruct
