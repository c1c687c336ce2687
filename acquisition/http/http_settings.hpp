#pragma once

#include <chrono>
#include <cstddef>

#include "acquisition/http/request_guard.hpp"

namespace biotomy::acquisition {

/// The threads of a lane, and how many requests may wait for them.
struct LaneSize {
  int threads = 1;
  std::size_t most_waiting = 64;
};

/// What a server bears. Whoever asks for more is turned away, or dropped.
struct HttpLimits {
  std::size_t connections = 256;
  std::size_t connections_of_an_address = 128;
  std::chrono::milliseconds request_time{5000};  ///< from a request's first byte to its last
  std::chrono::milliseconds idle_time{30000};    ///< of a connection between two requests
  std::chrono::milliseconds write_stall{10000};  ///< a client that takes nothing for so long
  int pictures_per_second = 50;                  ///< of an address; three times as many at once
  LaneSize commands{.threads = 2};
  LaneSize quick{.threads = 4};
  LaneSize files{.threads = 2};
  LaneSize pictures{.threads = 2};
};

struct HttpSettings {
  HttpLimits limits;
  GuardSettings guard;
};

}  // namespace biotomy::acquisition
