#include "acquisition/records/event_writer.hpp"

#include <mutex>
#include <utility>

#include "acquisition/records/layer_journal.hpp"

namespace biotomy::acquisition {

/// The path and the connection belong to the worker, the failure to whoever holds the mutex.
struct EventWriter::State {
  std::filesystem::path path;
  std::optional<LayerJournal> journal;  // once there was something to write
  std::mutex mutex;
  std::optional<std::string> failure;

  void write(const JobEventRow& event) {
    try {
      if (!journal) journal.emplace(path);
      journal->record_event(event);
    } catch (const std::exception& error) {
      const std::scoped_lock lock(mutex);
      if (!failure) failure = error.what();
    }
  }
};

EventWriter::EventWriter(Worker& worker, std::filesystem::path journal)
    : worker_(worker), state_(std::make_shared<State>()) {
  state_->path = std::move(journal);
}

EventWriter::~EventWriter() {
  worker_.post([state = std::move(state_)] { state->journal.reset(); });
}

void EventWriter::post(JobEventRow event) {
  worker_.post([state = state_, event = std::move(event)] { state->write(event); });
}

std::optional<std::string> EventWriter::failure() const {
  const std::scoped_lock lock(state_->mutex);
  return state_->failure;
}

}  // namespace biotomy::acquisition
