#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>

#include <oneapi/tbb/task_arena.h>

#include "acquisition/http/message.hpp"
#include "acquisition/viewer/live_sample.hpp"

namespace biotomy::acquisition {

struct ExportSettings {
  std::filesystem::path folder;  ///< made with the first export; nothing else of it is touched
  std::function<std::uint64_t()> bytes_to_spare = {};  ///< of its disk; if none: all but 1 GiB
  std::size_t cache_bytes = 0;                         ///< of decoded chunks
};

/// Exports: sections at full resolution, series and films, made one after the other by one thread
/// of low priority. At most 8 wait; the last 20 of at most 8 GiB together are kept, also from one
/// program to the next. Safe for many threads.
class ExportQueue {
 public:
  /// `live` and the arena, in whose threads pictures are sampled, outlive it.
  ExportQueue(LiveSample& live, tbb::task_arena& arena, ExportSettings settings);

  /// What is being made is given up.
  ~ExportQueue();
  ExportQueue(const ExportQueue&) = delete;
  ExportQueue& operator=(const ExportQueue&) = delete;

  /// Is told of each export that changed, as its JSON in one line, by the thread that changed it:
  /// its state at once, its progress at most four times a second.
  void on_change(std::function<void(std::string json)> listener);

  /// POST, GET, GET of one, DELETE. Throw Refusal, InvalidRequest, SampleError.
  ApiResponse add(const ApiRequest& request);
  ApiResponse list() const;
  ApiResponse one(const std::string& id) const;

  /// Cancels it, or removes it when it has ended.
  ApiResponse remove(const std::string& id);

  /// GET of a file of one that is done.
  ApiResponse file(const std::string& id, const std::string& name, const ApiRequest& request) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace biotomy::acquisition
