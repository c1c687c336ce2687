#include "acquisition/service/notifications/courier.hpp"

#include <algorithm>
#include <condition_variable>
#include <mutex>
#include <optional>
#include <set>
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
  bool fresh = false;                        ///< a message came since the last attempt
  std::set<std::uint64_t> refused;           ///< numbers of messages that wait
  std::chrono::milliseconds grown_pause{0};  ///< of the failures since the last delivery
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
      const Outcome outcome = attempt(message.text, stop);
      lock.lock();
      if (outcome.failure) {
        ++failed_attempts;
        pause = pause_after(message.number, outcome);
        log_warning("notify", channel->name() + ": " + *outcome.failure + "; again in " +
                                  std::to_string(grown_pause.count()) + " ms");
      } else {
        ++delivered;
        refused.erase(message.number);
        queue.pop(message.number);
        pause = grown_pause = std::chrono::milliseconds(0);
      }
    }
  }

  struct Outcome {
    std::optional<std::string> failure;  ///< why; nothing when the message is delivered
    bool is_refused = false;             ///< this message, which says nothing of others
  };

  /// Of a refused message none, if there is one behind it that was not refused.
  std::chrono::milliseconds pause_after(std::uint64_t number, const Outcome& outcome) {
    if (outcome.is_refused) {
      refused.insert(number);
      queue.postpone(number);
      if (!refused.contains(queue.front()->number)) return std::chrono::milliseconds(0);
    }
    grown_pause = std::clamp(2 * grown_pause, settings.first_retry, settings.longest_retry);
    return grown_pause;
  }

  Outcome attempt(const std::string& text, const std::stop_token& stop) {
    try {
      channel->deliver(text, settings.time_out, stop);
      return {};
    } catch (const MessageRefused& error) {
      return {error.what(), true};
    } catch (const DeliveryError& error) {
      return {error.what(), false};
    } catch (const std::exception& error) {
      return {error.what(), true};
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
