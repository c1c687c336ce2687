#include "acquisition/http/http_connection.hpp"

#include <algorithm>
#include <utility>

#include <boost/asio/buffer.hpp>
#include <boost/asio/post.hpp>

#include "acquisition/http/response_head.hpp"

namespace biotomy::acquisition {
namespace {

namespace asio = boost::asio;
using asio::ip::tcp;
using boost::system::error_code;
using std::chrono::steady_clock;

constexpr std::size_t kReadPiece = 16384;
constexpr std::size_t kMostAhead = kLongestHeader + kLargestBody;  // received before it is wanted
constexpr std::size_t kFilePiece = 262144;
constexpr std::chrono::milliseconds kDrainTime{2000};
// Less than the system's own choice, so that a listener that takes nothing is noticed soon.
constexpr int kEventSendBuffer = 65536;

EventText shared(std::string text) {
  return std::make_shared<const std::string>(std::move(text));
}

}  // namespace

HttpConnection::HttpConnection(tcp::socket socket, ConnectionHost& host, const HttpLimits& limits,
                               std::string client)
    : socket_(std::move(socket)),
      timer_(socket_.get_executor()),
      host_(host),
      limits_(limits),
      client_(std::move(client)),
      piece_(kReadPiece, '\0') {}

void HttpConnection::begin() {
  limit_to(limits_.request_time);
  read();
}

void HttpConnection::close() {
  if (state_ == State::closed) return;
  state_ = State::closed;
  *left_ = true;
  if (events_) events_->on_event({});
  events_.reset();
  output_.clear();
  error_code ignored;
  socket_.close(ignored);
  timer_.cancel();
  host_.gone(shared_from_this());
}

/// Always under way, also while a request is worked on: only so is it heard that a client leaves.
void HttpConnection::read() {
  if (reading_ || input_ended_ || input_.size() >= kMostAhead) return;
  reading_ = true;
  socket_.async_read_some(asio::buffer(piece_),
                          [self = shared_from_this()](const error_code& error, std::size_t bytes) {
                            self->received(error, bytes);
                          });
}

void HttpConnection::received(const error_code& error, std::size_t bytes) {
  reading_ = false;
  if (state_ == State::closed) return;
  if (error) {
    input_ended_ = true;
    // Who sends no more may still want the answer that is on its way, but not one that costs work:
    // it cannot be told from somebody who left.
    if (error != asio::error::eof || state_ != State::sending) close();
    return;
  }
  if (state_ == State::draining) {
    read();
    return;
  }
  const bool begins_a_request = input_.empty() && reader_.is_between_requests();
  if (state_ == State::receiving && begins_a_request) limit_to(limits_.request_time);
  input_.append(piece_, 0, bytes);
  if (state_ == State::receiving) advance();
  if (state_ != State::closed) read();
}

void HttpConnection::advance() {
  switch (reader_.take(input_)) {
    case RequestReader::Outcome::needs_more:
      if (reader_.take_expectation()) send(shared("HTTP/1.1 100 Continue\r\n\r\n"));
      return;
    case RequestReader::Outcome::complete:
      serve(reader_.request());
      return;
    case RequestReader::Outcome::refused:
      asked_ = {};
      head_only_ = false;
      keep_alive_ = false;
      respond(reader_.refusal());
      return;
  }
}

void HttpConnection::serve(ReceivedRequest received) {
  no_limit();
  state_ = State::working;
  head_only_ = received.head_only;
  keep_alive_ = received.keep_alive;
  ApiRequest& request = received.request;
  request.client = client_;
  request.client_left = [left = left_] { return left->load(); };
  asked_ = request;
  asked_.body.clear();
  auto answered = [self = shared_from_this()](ApiResponse response) {
    self->respond(std::move(response));
  };
  if (auto response = host_.take_on(std::move(request), std::move(answered))) {
    respond(std::move(*response));
  }
}

void HttpConnection::respond(ApiResponse response) {
  if (state_ == State::closed) return;
  host_.mark(asked_, response);
  state_ = State::sending;
  limit_to(limits_.write_stall);
  if (response.events && !head_only_) {
    keep_alive_ = false;
    send(shared(response_head(response, std::nullopt, false)));
    events_ = std::move(response.events);
    error_code ignored;
    socket_.set_option(asio::socket_base::send_buffer_size(kEventSendBuffer), ignored);
    // The feed's thread must not touch this connection, nor keep it.
    events_->on_event([executor = socket_.get_executor(), weak = weak_from_this()] {
      asio::post(executor, [weak] {
        if (const auto self = weak.lock()) self->tell();
      });
    });
    state_ = State::telling;
    return;
  }
  const std::uint64_t length = response.file ? response.file->bytes : response.body.size();
  std::string head = response_head(response, length, keep_alive_);
  if (response.file && !head_only_) {
    file_ = response.file->file;
    file_offset_ = response.file->begin;
    file_left_ = response.file->bytes;
  }
  send(shared(std::move(head)));
  if (!response.file && !head_only_ && !response.body.empty()) {
    send(shared(std::move(response.body)));
  }
}

void HttpConnection::tell() {
  if (state_ != State::telling || writing_) return;
  for (EventText& text : events_->take()) output_.push_back(std::move(text));
  if (!output_.empty()) {
    limit_to(limits_.write_stall);
    write();
  }
}

void HttpConnection::send_file_on() {
  const auto bytes = static_cast<std::size_t>(std::min<std::uint64_t>(file_left_, kFilePiece));
  const std::uint64_t offset = file_offset_;
  file_offset_ += bytes;
  file_left_ -= bytes;
  no_limit();  // it is the disk that is waited for
  host_.read_file(file_, offset, bytes, left_,
                  [self = shared_from_this()](std::optional<std::string> piece) {
                    if (self->state_ == State::closed) return;
                    // The length is told already: all that can be done is to end early.
                    if (!piece) return self->close();
                    self->limit_to(self->limits_.write_stall);
                    self->send(shared(std::move(*piece)));
                  });
}

void HttpConnection::send(EventText bytes) {
  output_.push_back(std::move(bytes));
  write();
}

void HttpConnection::write() {
  if (writing_ || output_.empty()) return;
  writing_ = true;
  // The text is kept by the handler: a connection that is closed forgets what it had to send.
  const EventText text = output_.front();
  socket_.async_write_some(
      asio::buffer(text->data() + output_sent_, text->size() - output_sent_),
      [self = shared_from_this(), text](const error_code& error, std::size_t bytes) {
        self->written(error, bytes);
      });
}

void HttpConnection::written(const error_code& error, std::size_t bytes) {
  writing_ = false;
  if (state_ == State::closed) return;
  if (error) return close();
  if (state_ == State::sending || state_ == State::telling) limit_to(limits_.write_stall);
  output_sent_ += bytes;
  if (output_sent_ >= output_.front()->size()) {
    output_.pop_front();
    output_sent_ = 0;
  }
  if (!output_.empty()) {
    write();
  } else if (state_ == State::telling) {
    no_limit();
    tell();
  } else if (state_ == State::sending) {
    file_left_ > 0 ? send_file_on() : sent();
  }
}

void HttpConnection::sent() {
  file_.reset();
  if (!keep_alive_ || input_ended_) return drain();
  state_ = State::receiving;
  if (input_.empty()) {
    limit_to(limits_.idle_time);
  } else {
    limit_to(limits_.request_time);
    advance();
  }
  if (state_ != State::closed) read();
}

/// A connection that is closed while something of the client is unread takes the answer with it.
void HttpConnection::drain() {
  if (input_ended_) return close();
  state_ = State::draining;
  input_.clear();
  error_code ignored;
  socket_.shutdown(tcp::socket::shutdown_send, ignored);
  limit_to(kDrainTime);
  read();
}

void HttpConnection::limit_to(std::chrono::milliseconds time) {
  limit_ = steady_clock::now() + time;
  // A limit that moved away is noticed when the timer fires; one that came nearer needs a new one.
  if (!limit_watched_ || timer_.expiry() > *limit_) watch_limit();
}

void HttpConnection::no_limit() {
  limit_.reset();
}

void HttpConnection::watch_limit() {
  limit_watched_ = true;
  timer_.expires_at(*limit_);
  timer_.async_wait([weak = weak_from_this()](const error_code& error) {
    const auto self = weak.lock();
    if (!self || self->state_ == State::closed || error) return;
    self->limit_watched_ = false;
    if (!self->limit_) return;
    if (steady_clock::now() >= *self->limit_) {
      self->close();
    } else {
      self->watch_limit();
    }
  });
}

}  // namespace biotomy::acquisition
