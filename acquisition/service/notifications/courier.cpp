#include "acquisition/service/notifications/courier.hpp"

#include <algorithm>
#include <condition_variable>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>

#include "acquisition/log.hpp"
#include "acquisition/service/notifications/message_queue.hpp"

namespace biotomy::acquisition {

struct Courier::State {
  State(std::unique_ptr<Channel> way, const std::filesystem::path& folder,
        const CourierSettings& wanted)
      : channel(std::move(way)),
        settings(wanted),
        queue(folder, static_cast<std::size_t>(wanted.keep)) {}

  std::unique_ptr<Channel> channel;
  CourierSettings settings;
  mutable std::mutex mutex;
  std::condition_variable_any changed;
  MessageQueue queue;
  bool fresh = false;  ///< a message came since the last attempt
  std::uint64_t delivered = 0;
  std::uint64_t failed_attempts = 0;
  std::jthread thread;

  void run(const std::stop_token& stop) {
    std::chrono::milliseconds pause{0};  // before the next attempt
    std::unique_lock lock(mutex);
    while (!stop.stop_requested()) {
      // A new message does not wait for the pause of an old one: the way may be free by now.
      changed.wait_for(lock, stop, pause, [this] { return fresh; });
      changed.wait(lock, stop, [this] { return queue.size() > 0; });
      if (stop.stop_requested()) return;
      fresh = false;
      const MessageQueue::Message message = *queue.front();
      lock.unlock();
      const std::optional<std::string> failure = attempt(message.text, stop);
      lock.lock();
      if (!failure) {
        ++delivered;
        pause = std::chrono::milliseconds(0);
        queue.pop(message.number);
        continue;
      }
      ++failed_attempts;
      pause = std::clamp(2 * pause, settings.first_retry, settings.longest_retry);
      log_warning("notify", channel->name() + ": " + *failure + "; again in " +
                                std::to_string(pause.count()) + " ms");
    }
  }

  /// Why it failed; nothing when the message is delivered.
  std::optional<std::string> attempt(const std::string& text, const std::stop_token& stop) {
    try {
      channel->deliver(text, settings.time_out, stop);
      return std::nullopt;
    } catch (const std::exception& error) {
      return error.what();
    }
  }
};

Courier::Courier(std::unique_ptr<Channel> channel, const std::filesystem::path& folder,
                 const CourierSettings& settings)
    : state_(std::make_unique<State>(std::move(channel), folder, settings)) {
  state_->thread =
      std::jthread([state = state_.get()](const std::stop_token& stop) { state->run(stop); });
}

Courier::~Courier() {
  state_->thread.request_stop();
  state_->thread.join();
}

void Courier::take(const std::string& message) {
  {
    const std::scoped_lock lock(state_->mutex);
    state_->queue.push(message);
    state_->fresh = true;
  }
  state_->changed.notify_all();
}

Courier::Figures Courier::figures() const {
  const std::scoped_lock lock(state_->mutex);
  return {.channel = state_->channel->name(),
          .waiting = state_->queue.size(),
          .delivered = state_->delivered,
          .failed_attempts = state_->failed_attempts,
          .dropped = state_->queue.dropped()};
}

}  // namespace biotomy::acquisition
