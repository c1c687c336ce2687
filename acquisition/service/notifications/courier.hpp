#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>

#include "acquisition/service/notifications/channel.hpp"

namespace biotomy::acquisition {

struct CourierSettings {
  int keep = 200;  ///< messages that wait at most
  std::chrono::milliseconds time_out{10000};
  std::chrono::milliseconds first_retry{5000};
  std::chrono::milliseconds longest_retry{600000};
};

/// Takes messages to one channel, from a thread of its own: one after the other, each again until
/// it is delivered, with pauses that grow and that a new message ends. One that is refused is put
/// behind the others, so that it holds none up. What is not delivered yet lies in a folder and is
/// taken up by the next courier; a message may so arrive twice, never not at all.
class Courier {
 public:
  /// Throws SampleError when the folder cannot be made or read.
  Courier(std::unique_ptr<Channel> channel, const std::filesystem::path& folder,
          const CourierSettings& settings);
  /// Waits for the attempt at hand, which is told to give up.
  ~Courier();
  Courier(const Courier&) = delete;
  Courier& operator=(const Courier&) = delete;

  /// The message is in the queue on disk when this returns.
  void take(const std::string& message);

  struct Figures {
    std::string channel;
    std::uint64_t waiting = 0;
    std::uint64_t delivered = 0;
    std::uint64_t failed_attempts = 0;
    std::uint64_t dropped = 0;
  };
  Figures figures() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace biotomy::acquisition
