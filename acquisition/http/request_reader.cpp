#include "acquisition/http/request_reader.hpp"

#include <utility>

#include <boost/asio/buffer.hpp>
#include <boost/beast/http/parser.hpp>
#include <boost/beast/http/string_body.hpp>

#include "acquisition/http/request_target.hpp"

namespace biotomy::acquisition {
namespace {

namespace http = boost::beast::http;

constexpr unsigned kHttp11 = 11;

struct Refusal {
  int status;
  const char* sentence;
};

constexpr Refusal kUnreadable{400, "the request cannot be understood"};
constexpr Refusal kNoLength{411, "the body needs a Content-Length"};
constexpr Refusal kHeaderTooLong{431, "the header is too long"};
constexpr Refusal kTargetTooLong{414, "the address is too long"};
constexpr Refusal kBodyTooLarge{413, "the body is too large"};

}  // namespace

struct RequestReader::State {
  std::optional<http::request_parser<http::string_body>> parser;
  bool expectation_taken = false;
  std::optional<RequestTarget> target;
  std::optional<Refusal> refusal;

  State() { begin(); }

  void begin() {
    parser.emplace();
    parser->eager(false);  // the header is looked at before the body is read
    parser->header_limit(kLongestHeader);
    parser->body_limit(kLargestBody);
    expectation_taken = false;
    target.reset();
  }

  std::string header(http::field name) const { return std::string(parser->get()[name]); }
  std::string header(const char* name) const { return std::string(parser->get()[name]); }

  Outcome refuse(const Refusal& why) {
    refusal = why;
    return Outcome::refused;
  }

  /// `unread`: the bytes that the parser has not taken.
  Refusal refusal_of(const boost::beast::error_code& error, const std::string& unread) const {
    if (error == http::error::body_limit) return kBodyTooLarge;
    if (error != http::error::header_limit) return kUnreadable;
    // A first line that has no end in so many bytes is all target.
    const bool line_ended =
        !parser->get().target().empty() || unread.find('\n') != std::string::npos;
    return line_ended ? kHeaderTooLong : kTargetTooLong;
  }

  /// Once the header is there. False when what it says is refused.
  bool check_header() {
    if (target) return true;
    const auto asked = parser->get().target();
    if (asked.size() > kLongestTarget) {
      refusal = kTargetTooLong;
      return false;
    }
    target = parse_target({asked.data(), asked.size()});
    if (!target) {
      refusal = kUnreadable;
      return false;
    }
    // None of our clients sends a body in chunks, and Beast's parser of chunks trips over some.
    if (parser->chunked()) {
      refusal = kNoLength;
      return false;
    }
    parser->eager(true);
    return true;
  }
};

RequestReader::RequestReader() : state_(std::make_unique<State>()) {}

RequestReader::~RequestReader() = default;

RequestReader::Outcome RequestReader::take(std::string& bytes) {
  State& state = *state_;
  if (state.refusal) return Outcome::refused;
  while (!bytes.empty() && !state.parser->is_done()) {
    boost::beast::error_code error;
    const std::size_t used =
        state.parser->put(boost::asio::const_buffer(bytes.data(), bytes.size()), error);
    if (error && error != http::error::need_more) {
      return state.refuse(state.refusal_of(error, bytes));
    }
    bytes.erase(0, used);
    if (state.parser->is_header_done() && !state.check_header()) return Outcome::refused;
    if (used == 0) break;
  }
  if (!state.parser->is_done()) {
    // The parser looks at a header's length only when it has all of it.
    const bool too_long = !state.parser->is_header_done() && bytes.size() > kLongestHeader;
    return too_long ? state.refuse(state.refusal_of(http::error::header_limit, bytes))
                    : Outcome::needs_more;
  }
  return Outcome::complete;
}

bool RequestReader::is_between_requests() const {
  return !state_->parser->got_some();
}

ReceivedRequest RequestReader::request() {
  State& state = *state_;
  const auto& message = state.parser->get();
  ReceivedRequest received{
      .request = {}, .head_only = false, .keep_alive = state.parser->keep_alive()};
  ApiRequest& request = received.request;
  const auto method = message.method_string();
  request.method.assign(method.data(), method.size());
  received.head_only = request.method == "HEAD";
  if (received.head_only) request.method = "GET";
  request.path = std::move(state.target->path);
  request.query = std::move(state.target->query);
  request.authorization = state.header(http::field::authorization);
  request.origin = state.header(http::field::origin);
  request.range = state.header(http::field::range);
  request.if_none_match = state.header(http::field::if_none_match);
  request.if_range = state.header(http::field::if_range);
  request.accept_encoding = state.header(http::field::accept_encoding);
  request.host = state.header(http::field::host);
  request.sec_fetch_site = state.header("Sec-Fetch-Site");
  request.sec_fetch_mode = state.header("Sec-Fetch-Mode");
  request.last_event_id = state.header("Last-Event-ID");
  request.asks_private_network = state.header("Access-Control-Request-Private-Network") == "true";
  request.body = message.body();
  state.begin();
  return received;
}

ApiResponse RequestReader::refusal() const {
  const Refusal& why = state_->refusal.value_or(kUnreadable);
  return error_response(why.status, why.sentence);
}

bool RequestReader::take_expectation() {
  State& state = *state_;
  if (state.expectation_taken || !state.parser->is_header_done() || state.parser->is_done()) {
    return false;
  }
  state.expectation_taken = true;
  return state.parser->get().version() == kHttp11 &&
         boost::beast::iequals(state.parser->get()[http::field::expect], "100-continue");
}

}  // namespace biotomy::acquisition
