#include "acquisition/service/notifications/notifier.hpp"

#include <condition_variable>
#include <fstream>
#include <iterator>
#include <mutex>
#include <thread>
#include <utility>

#include <openssl/rand.h>

#include "acquisition/log.hpp"
#include "acquisition/service/notifications/notice_fold.hpp"
#include "reconstruct/disk/durable_file.hpp"

namespace biotomy::acquisition {
namespace {

using std::chrono::steady_clock;

constexpr const char* kComponent = "notify";
constexpr const char* kWorkFile = "rig-at-work";
constexpr const char* kFailedStartFile = "failed-start";
constexpr std::size_t kMostInHand = 1000;
constexpr std::chrono::hours kNever{24 * 365};

std::string random_id() {
  std::array<unsigned char, 16> bytes{};
  RAND_bytes(bytes.data(), static_cast<int>(bytes.size()));
  constexpr const char* kDigits = "0123456789abcdef";
  std::string id;
  for (const unsigned char byte : bytes) {
    id += kDigits[byte >> 4U];
    id += kDigits[byte & 15U];
  }
  return id;
}

std::optional<std::string> content_of(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  if (!stream) return std::nullopt;
  return std::string(std::istreambuf_iterator<char>(stream), {});
}

}  // namespace

struct Notifier::State {
  State(const NotifierSettings& wanted, std::vector<std::unique_ptr<Channel>> channels)
      : settings(wanted), fold(wanted.fold_window) {
    reconstruct::create_folders_durably(settings.queue);
    interrupted = content_of(settings.queue / kWorkFile);
    for (std::unique_ptr<Channel>& channel : channels) {
      const std::filesystem::path folder = settings.queue / channel->name();
      couriers.push_back(std::make_unique<Courier>(std::move(channel), folder, settings.courier));
    }
  }

  NotifierSettings settings;
  std::optional<std::string> interrupted;
  std::vector<std::unique_ptr<Courier>> couriers;
  NoticeFold fold;  // of the thread

  std::mutex mutex;
  std::condition_variable_any changed;
  std::vector<Notice> in_hand;
  std::optional<std::string> work;  ///< to be written
  bool wake = false;
  std::jthread thread;

  void run(const std::stop_token& stop) {
    std::unique_lock lock(mutex);
    while (true) {
      const TimePoint until = fold.next_due().value_or(steady_clock::now() + kNever);
      changed.wait_until(lock, stop, until, [this] { return wake; });
      wake = false;
      const bool last = stop.stop_requested();
      const std::vector<Notice> notices = std::exchange(in_hand, {});
      const std::optional<std::string> at_work = std::exchange(work, std::nullopt);
      lock.unlock();
      if (at_work) {
        keep(kWorkFile, *at_work);
        keep(kFailedStartFile, "");
      }
      for (const Notice& notice : notices) {
        if (const auto now = fold.take(notice, steady_clock::now())) send(*now);
      }
      for (const Notice& notice : fold.due(steady_clock::now(), last)) send(notice);
      lock.lock();
      if (last && in_hand.empty() && !work) return;
    }
  }

  void send(const Notice& notice) {
    const std::string message = notice_json(notice, random_id());
    log_info(kComponent, message);
    for (const auto& courier : couriers) courier->take(message);
  }

  /// An empty text: the file goes.
  void keep(const char* name, const std::string& text) const {
    const std::filesystem::path file = settings.queue / name;
    try {
      if (!text.empty()) {
        reconstruct::write_durably(file, text);
      } else if (std::filesystem::remove(file)) {
        reconstruct::sync_folder(settings.queue);
      }
    } catch (const std::exception& error) {
      log_error(kComponent, error.what());
    }
  }
};

Notifier::Notifier(const NotifierSettings& settings, std::vector<std::unique_ptr<Channel>> channels)
    : state_(std::make_unique<State>(settings, std::move(channels))) {
  state_->thread =
      std::jthread([state = state_.get()](const std::stop_token& stop) { state->run(stop); });
}

Notifier::~Notifier() {
  state_->thread.request_stop();
  state_->thread.join();
}

const std::optional<std::string>& Notifier::interrupted() const {
  return state_->interrupted;
}

void Notifier::tell(Notice notice) {
  {
    const std::scoped_lock lock(state_->mutex);
    // More than a person could read lies there only when the disk hangs.
    if (state_->in_hand.size() < kMostInHand) state_->in_hand.push_back(std::move(notice));
    state_->wake = true;
  }
  state_->changed.notify_all();
}

void Notifier::tell_of_failed_start(const Notice& notice) {
  if (content_of(state_->settings.queue / kFailedStartFile) == notice.text) return;
  tell(notice);
  state_->keep(kFailedStartFile, notice.text);
}

void Notifier::work(std::string at_what) {
  {
    const std::scoped_lock lock(state_->mutex);
    state_->work = std::move(at_what);
    state_->wake = true;
  }
  state_->changed.notify_all();
}

std::vector<Courier::Figures> Notifier::figures() const {
  std::vector<Courier::Figures> figures;
  for (const auto& courier : state_->couriers) figures.push_back(courier->figures());
  return figures;
}

}  // namespace biotomy::acquisition
