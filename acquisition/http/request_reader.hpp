#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "acquisition/http/message.hpp"

namespace biotomy::acquisition {

inline constexpr std::size_t kLongestHeader = 16384;  ///< of a request, in bytes, its target too
inline constexpr std::size_t kLongestTarget = 8192;
inline constexpr std::size_t kLargestBody = 65536;

/// A request as it came, with what HTTP itself needs to know of it.
struct ReceivedRequest {
  ApiRequest request;      ///< without `client` and `client_left`
  bool head_only = false;  ///< it was HEAD
  bool keep_alive = true;  ///< the connection may be used again
};

/// Reads the requests of one connection from its bytes, one after the other. Headers over 16 KiB,
/// targets over 8 KiB and bodies over 64 KiB are refused before they are read, and so are bodies
/// that do not say how long they are.
class RequestReader {
 public:
  RequestReader();
  ~RequestReader();
  RequestReader(const RequestReader&) = delete;
  RequestReader& operator=(const RequestReader&) = delete;

  enum class Outcome { needs_more, complete, refused };

  /// Takes from the front of `bytes` what belongs to the request at hand; what it leaves is to be
  /// given again, with more.
  Outcome take(std::string& bytes);

  /// Whether nothing of the next request has been taken yet.
  bool is_between_requests() const;

  /// After `complete`: the request; the reader begins the next one.
  ReceivedRequest request();

  /// After `refused`: why. The connection cannot be used any more.
  ApiResponse refusal() const;

  /// The client waits to be told that it may send the body. True once for a request.
  bool take_expectation();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace biotomy::acquisition
