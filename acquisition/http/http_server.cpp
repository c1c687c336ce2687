#include "acquisition/http/http_server.hpp"

#include <algorithm>
#include <chrono>
#include <map>
#include <set>
#include <string_view>
#include <thread>
#include <utility>

#include <boost/asio/executor_work_guard.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/ip/v6_only.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/steady_timer.hpp>
#include <fcntl.h>
#include <pthread.h>
#include <sys/socket.h>
#include <unistd.h>

#include "acquisition/http/http_connection.hpp"
#include "acquisition/http/rate_limit.hpp"
#include "acquisition/http/request_guard.hpp"
#include "acquisition/http/work_lane.hpp"
#include "acquisition/log.hpp"

namespace biotomy::acquisition {
namespace {

namespace asio = boost::asio;
using asio::ip::tcp;
using boost::system::error_code;
using std::chrono::steady_clock;

// A history of ten thousand layers is a quick look that costs as much as a picture: nobody who asks
// for it again and again takes the processor from the run.
constexpr int kNice = 5;
constexpr int kPicturesNice = 10;
constexpr int kPicturesAtOnce = 3;  // times those of a second
constexpr std::chrono::seconds kRetry{1};
constexpr std::chrono::milliseconds kAcceptPause{100};  // after the system had no room
constexpr std::string_view kFull =
    "HTTP/1.1 503 Service Unavailable\r\nRetry-After: 1\r\nContent-Length: 0\r\n"
    "Connection: close\r\n\r\n";

std::string cannot_listen_text(const std::string& host, int port, const error_code& why) {
  return "cannot listen on " + host + ":" + std::to_string(port) + ", \"" + why.message() +
         "\": perhaps another program has the port, or the address is not this computer's; choose "
         "another";
}

/// Programs that the daemon starts must not hold its connections open.
void close_in_children(int descriptor) {
  ::fcntl(descriptor, F_SETFD, FD_CLOEXEC);
}

/// Only SO_REUSEADDR is set: with SO_REUSEPORT a second daemon could listen on the same port
/// without anybody noticing.
error_code open_at(tcp::acceptor& acceptor, const tcp::endpoint& address) {
  error_code error;
  acceptor.open(address.protocol(), error);
  if (error) return error;
  close_in_children(acceptor.native_handle());
  acceptor.set_option(asio::socket_base::reuse_address(true), error);
  if (address.address().is_v6()) {
    error_code ignored;  // where a system has no IPv4 beside it
    acceptor.set_option(asio::ip::v6_only(false), ignored);
  }
  acceptor.bind(address, error);
  if (!error) acceptor.listen(asio::socket_base::max_listen_connections, error);
  if (error) {
    error_code ignored;
    acceptor.close(ignored);
  }
  return error;
}

tcp::acceptor listening_at(asio::io_context& context, const std::string& host, int port) {
  error_code error;
  const auto addresses =
      tcp::resolver(context).resolve(host, std::to_string(port), tcp::resolver::passive, error);
  if (!error) {
    for (const auto& entry : addresses) {
      tcp::acceptor acceptor(context);
      error = open_at(acceptor, entry.endpoint());
      if (!error) return acceptor;
    }
  }
  throw ListenError(cannot_listen_text(host, port, error));
}

std::string text_of(const asio::ip::address& address) {
  if (address.is_v6() && address.to_v6().is_v4_mapped()) {
    return asio::ip::make_address_v4(asio::ip::v4_mapped, address.to_v6()).to_string();
  }
  return address.to_string();
}

ApiResponse answer_of(const HttpApplication& application, const ApiRequest& request) {
  try {
    return application.answer(request);
  } catch (const std::exception& error) {
    log_error("http", request.path + ": " + error.what());
    return error_response(500, error.what());
  }
}

std::optional<std::string> piece_of(int file, std::uint64_t offset, std::size_t bytes) {
  std::string piece(bytes, '\0');
  std::size_t done = 0;
  while (done < bytes) {
    const ssize_t read =
        ::pread(file, piece.data() + done, bytes - done, static_cast<off_t>(offset + done));
    if (read <= 0) return std::nullopt;
    done += static_cast<std::size_t>(read);
  }
  return piece;
}

}  // namespace

class HttpServer::Listening : public ConnectionHost {
 public:
  Listening(const HttpApplication& application, const std::string& host, int port,
            HttpSettings settings)
      : application_(application),
        limits_(settings.limits),
        guard_(std::move(settings.guard)),
        pictures_of_clients_(limits_.pictures_per_second * kPicturesAtOnce,
                             std::chrono::milliseconds(1000) / limits_.pictures_per_second),
        acceptor_(listening_at(context_, host, port)),
        accept_timer_(context_),
        commands_("http-commands", limits_.commands.threads, limits_.commands.most_waiting, 0),
        quick_("http-quick", limits_.quick.threads, limits_.quick.most_waiting, kNice),
        files_("http-files", limits_.files.threads, limits_.files.most_waiting, kNice),
        pictures_("http-pictures", limits_.pictures.threads, limits_.pictures.most_waiting,
                  kPicturesNice) {
    accept();
    thread_ = std::thread([this] {
      ::pthread_setname_np(::pthread_self(), "http");
      run();
    });
  }

  ~Listening() override {
    asio::post(context_, [this] {
      ending_ = true;
      error_code ignored;
      acceptor_.close(ignored);
      accept_timer_.cancel();
      const auto all = connections_;
      for (const auto& connection : all) connection->close();
      keep_running_.reset();  // it ends when the last of what is under way has ended
    });
    thread_.join();
  }

  int port() const { return acceptor_.local_endpoint().port(); }

  std::optional<ApiResponse> take_on(ApiRequest request,
                                     std::function<void(ApiResponse)> answered) override {
    if (auto refused = guard_.answer(request)) return refused;
    const Lane kind = application_.lane(request);
    if (kind == Lane::pictures) {
      if (pictures_of_clients_.take(request.client, steady_clock::now())) {
        return later_response(
            429, "too many pictures are asked from this address: ask a little later", kRetry);
      }
    }
    const auto asked = std::make_shared<ApiRequest>(std::move(request));
    const bool taken = lane(kind).post(
        {.run =
             [this, asked, answered = std::move(answered)] {
               auto ready = std::make_shared<ApiResponse>(answer_of(application_, *asked));
               asio::post(context_, [ready, answered] { answered(std::move(*ready)); });
             },
         .is_useless = asked->client_left});
    if (taken) return std::nullopt;
    return later_response(503, "too much is asked of this computer at once: ask a little later",
                          kRetry);
  }

  void read_file(std::shared_ptr<const bridge::UniqueFd> file, std::uint64_t offset,
                 std::size_t bytes, std::shared_ptr<std::atomic<bool>> left,
                 std::function<void(std::optional<std::string>)> done) override {
    files_.go_on({.run =
                      [this, file = std::move(file), offset, bytes, done = std::move(done)] {
                        asio::post(context_, [piece = piece_of(file->get(), offset, bytes),
                                              done]() mutable { done(std::move(piece)); });
                      },
                  .is_useless = [left = std::move(left)] { return left->load(); }});
  }

  void mark(const ApiRequest& request, ApiResponse& response) const override {
    guard_.mark(request, response);
  }

  void gone(const std::shared_ptr<HttpConnection>& connection) override {
    connections_.erase(connection);
    const auto found = of_address_.find(connection->client());
    if (found != of_address_.end() && --found->second == 0) of_address_.erase(found);
  }

 private:
  void run() {
    while (true) {
      try {
        context_.run();
        return;
      } catch (const std::exception& error) {
        log_error("http", error.what());
      }
    }
  }

  WorkLane& lane(Lane kind) {
    switch (kind) {
      case Lane::commands:
        return commands_;
      case Lane::files:
        return files_;
      case Lane::pictures:
        return pictures_;
      case Lane::quick:
        break;
    }
    return quick_;
  }

  void accept() {
    acceptor_.async_accept([this](const error_code& error, tcp::socket socket) {
      if (ending_) return;
      if (error) {
        // There are too many open files, for one: the next moment may be better.
        if (!std::exchange(no_room_, true)) {
          log_warning("http", "cannot take a connection, and tries on: " + error.message());
        }
        accept_timer_.expires_after(kAcceptPause);
        accept_timer_.async_wait([this](const error_code& cancelled) {
          if (!cancelled) accept();
        });
        return;
      }
      no_room_ = false;
      welcome(std::move(socket));
      accept();
    });
  }

  void welcome(tcp::socket socket) {
    error_code error;
    const tcp::endpoint from = socket.remote_endpoint(error);
    if (error) return;  // it has left already
    close_in_children(socket.native_handle());
    const std::string client = text_of(from.address());
    const auto found = of_address_.find(client);
    const std::size_t of_this = found == of_address_.end() ? 0 : found->second;
    if (connections_.size() >= limits_.connections ||
        of_this >= limits_.connections_of_an_address) {
      ::send(socket.native_handle(), kFull.data(), kFull.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
      return;
    }
    // Without it an answer on a kept connection waits 40 ms for the receipt of the one before.
    socket.set_option(tcp::no_delay(true), error);
    const auto connection =
        std::make_shared<HttpConnection>(std::move(socket), *this, limits_, client);
    ++of_address_[client];
    connections_.insert(connection);
    connection->begin();
  }

  const HttpApplication& application_;
  HttpLimits limits_;
  RequestGuard guard_;
  asio::io_context context_{1};
  asio::executor_work_guard<asio::io_context::executor_type> keep_running_{context_.get_executor()};
  // Only the server's own thread touches these, until it has ended.
  bool ending_ = false;
  bool no_room_ = false;  ///< for the last connection; it is logged
  RateLimit pictures_of_clients_;
  tcp::acceptor acceptor_;
  asio::steady_timer accept_timer_;
  std::set<std::shared_ptr<HttpConnection>> connections_;
  std::map<std::string, std::size_t> of_address_;  ///< connections of each
  std::thread thread_;
  // Last: their threads post to the context, and end first.
  WorkLane commands_;
  WorkLane quick_;
  WorkLane files_;
  WorkLane pictures_;
};

std::optional<std::string> listen_complaint(const std::string& host, int port) {
  try {
    asio::io_context context;
    listening_at(context, host, port);
    return std::nullopt;
  } catch (const ListenError& error) {
    return error.what();
  }
}

HttpServer::HttpServer(const HttpApplication& application, const std::string& host, int port,
                       HttpSettings settings)
    : listening_(std::make_unique<Listening>(application, host, port, std::move(settings))) {}

HttpServer::~HttpServer() = default;

int HttpServer::port() const {
  return listening_->port();
}

}  // namespace biotomy::acquisition
