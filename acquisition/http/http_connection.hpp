#pragma once

#include <atomic>
#include <chrono>
#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/steady_timer.hpp>

#include "acquisition/http/event_feed.hpp"
#include "acquisition/http/http_settings.hpp"
#include "acquisition/http/message.hpp"
#include "acquisition/http/request_reader.hpp"
#include "firmware_bridge/wire/unique_fd.hpp"

namespace biotomy::acquisition {

class HttpConnection;

/// What a connection needs of its server. All but `client_left` is asked in the server's thread.
class ConnectionHost {
 public:
  virtual ~ConnectionHost() = default;

  /// Has the request answered by another thread, which calls `answered` in the server's. What is
  /// returned instead is answered at once.
  virtual std::optional<ApiResponse> take_on(ApiRequest request,
                                             std::function<void(ApiResponse)> answered) = 0;

  /// Reads on in a file, by another thread; `done` is called in the server's, with nothing when
  /// the file could not be read.
  virtual void read_file(std::shared_ptr<const bridge::UniqueFd> file, std::uint64_t offset,
                         std::size_t bytes, std::shared_ptr<std::atomic<bool>> left,
                         std::function<void(std::optional<std::string>)> done) = 0;

  virtual void mark(const ApiRequest& request, ApiResponse& response) const = 0;
  virtual void gone(const std::shared_ptr<HttpConnection>& connection) = 0;
};

/// A client's connection: reads one request after the other and sends what is answered. What the
/// client sends ahead waits until the answer before it is sent. Only the server's thread touches
/// it; the wish of an event feed to be heard comes through the thread's queue.
class HttpConnection : public std::enable_shared_from_this<HttpConnection> {
 public:
  HttpConnection(boost::asio::ip::tcp::socket socket, ConnectionHost& host,
                 const HttpLimits& limits, std::string client);

  void begin();
  void close();

  const std::string& client() const { return client_; }

 private:
  enum class State {
    receiving,  // a request, or waits for one
    working,    // somebody answers
    sending,    // a response of known length
    telling,    // events
    draining,   // the last response is sent; waits for the client to end
    closed
  };

  void read();
  void received(const boost::system::error_code& error, std::size_t bytes);
  void advance();
  void serve(ReceivedRequest received);
  void respond(ApiResponse response);
  void tell();
  void send_file_on();
  void send(EventText bytes);
  void write();
  void written(const boost::system::error_code& error, std::size_t bytes);
  void sent();
  void drain();

  void limit_to(std::chrono::milliseconds time);
  void no_limit();
  void watch_limit();

  boost::asio::ip::tcp::socket socket_;
  boost::asio::steady_timer timer_;
  ConnectionHost& host_;
  HttpLimits limits_;
  std::string client_;
  State state_ = State::receiving;
  std::shared_ptr<std::atomic<bool>> left_ = std::make_shared<std::atomic<bool>>(false);

  RequestReader reader_;
  std::string input_;  // what was received and belongs to no request yet
  std::string piece_;  // where the next bytes are received
  bool reading_ = false;
  bool input_ended_ = false;

  ApiRequest asked_;  // what is being answered
  bool head_only_ = false;
  bool keep_alive_ = true;

  std::deque<EventText> output_;
  std::size_t output_sent_ = 0;  // of the first of them
  bool writing_ = false;
  std::shared_ptr<const bridge::UniqueFd> file_;
  std::uint64_t file_offset_ = 0;
  std::uint64_t file_left_ = 0;
  std::shared_ptr<EventSubscription> events_;

  std::optional<std::chrono::steady_clock::time_point> limit_;
  bool limit_watched_ = false;
};

}  // namespace biotomy::acquisition
