#pragma once

#include <chrono>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "acquisition/service/notifications/channel.hpp"
#include "acquisition/service/notifications/courier.hpp"
#include "acquisition/service/notifications/notice.hpp"

namespace biotomy::acquisition {

struct NotifierSettings {
  std::filesystem::path queue;  ///< the folder in which everything waits
  CourierSettings courier;
  std::chrono::milliseconds fold_window{900000};
};

/// Tells people: folds repeated notices together, puts each into the queue of every channel, and
/// lets a courier a channel deliver it. It also remembers on disk that the rig works, so that the
/// next daemon knows when this one ended without coming to rest.
/// `tell` and `work` only hand over: what touches disk and network is done by threads of its own.
class Notifier {
 public:
  /// Throws SampleError when the queue's folder cannot be made or read.
  Notifier(const NotifierSettings& settings, std::vector<std::unique_ptr<Channel>> channels);
  ~Notifier();
  Notifier(const Notifier&) = delete;
  Notifier& operator=(const Notifier&) = delete;

  /// What the last daemon was doing when it ended without coming to rest.
  const std::optional<std::string>& interrupted() const;

  void tell(Notice notice);

  /// That the daemon cannot start, of which each of many tries in a row would tell: it is told once
  /// until the text is another or a daemon has started. Writes a file.
  void tell_of_failed_start(const Notice& notice);

  /// The rig works, and at what; an empty text: it is at rest.
  void work(std::string at_what);

  std::vector<Courier::Figures> figures() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace biotomy::acquisition
