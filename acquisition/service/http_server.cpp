#include "acquisition/service/http_server.hpp"

#include <chrono>
#include <thread>

#include <httplib.h>
#include <netdb.h>
#include <sys/socket.h>

#include "acquisition/log.hpp"
#include "firmware_bridge/wire/unique_fd.hpp"

namespace biotomy::acquisition {
namespace {

constexpr std::size_t kLargestBody = 65536;
constexpr std::size_t kThreads = 8;
constexpr int kTimeOutSeconds = 5;
constexpr int kRequestsPerConnection = 100;
constexpr std::chrono::seconds kStartLimit{5};

/// The library's own default also sets SO_REUSEPORT, with which a second daemon could listen on the
/// same port without anybody noticing.
void set_socket_options(socket_t socket) {
  const int on = 1;
  ::setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &on, sizeof on);
}

ApiRequest api_request(const httplib::Request& request) {
  ApiRequest asked{.method = request.method == "HEAD" ? "GET" : request.method,
                   .path = request.path,
                   .query = {},
                   .authorization = request.get_header_value("Authorization"),
                   .body = request.body,
                   .client = request.remote_addr};
  for (const auto& [name, value] : request.params) asked.query[name] = value;
  return asked;
}

void put(const ApiResponse& from, httplib::Response& to) {
  to.status = from.status;
  to.set_content(from.body, from.content_type.c_str());
  to.set_header("Cache-Control", "no-store");
  to.set_header("X-Content-Type-Options", "nosniff");
  for (const auto& [name, value] : from.headers) to.set_header(name.c_str(), value.c_str());
}

const char* text_of(int status) {
  switch (status) {
    case 413:
      return "the body is too large";
    case 414:
      return "the address is too long";
    default:
      return "the request cannot be understood";
  }
}

std::string cannot_listen_text(const std::string& host, int port) {
  return "cannot listen on " + host + ":" + std::to_string(port) +
         ": another program has the port, or the address is not this computer's; see "
         "service.listen";
}

}  // namespace

struct HttpServer::State {
  httplib::Server server;
  int port = 0;
  std::thread thread;
};

std::optional<std::string> listen_complaint(const std::string& host, int port) {
  addrinfo hints{};
  hints.ai_socktype = SOCK_STREAM;
  hints.ai_flags = AI_PASSIVE;
  addrinfo* found = nullptr;
  if (::getaddrinfo(host.c_str(), std::to_string(port).c_str(), &hints, &found) != 0) {
    return cannot_listen_text(host, port);
  }
  const std::unique_ptr<addrinfo, decltype(&::freeaddrinfo)> addresses(found, ::freeaddrinfo);
  for (const addrinfo* address = found; address != nullptr; address = address->ai_next) {
    const bridge::UniqueFd socket(::socket(address->ai_family, SOCK_STREAM | SOCK_CLOEXEC, 0));
    if (!socket.valid()) continue;
    set_socket_options(socket.get());
    if (::bind(socket.get(), address->ai_addr, address->ai_addrlen) == 0) return std::nullopt;
  }
  return cannot_listen_text(host, port);
}

HttpServer::HttpServer(const Api& api, const std::string& host, int port)
    : state_(std::make_unique<State>()) {
  httplib::Server& server = state_->server;
  server.new_task_queue = [] { return new httplib::ThreadPool(kThreads); };
  server.set_socket_options(set_socket_options);
  // Without it an answer on a kept connection waits 40 ms for the receipt of the one before.
  server.set_tcp_nodelay(true);
  server.set_payload_max_length(kLargestBody);
  server.set_read_timeout(kTimeOutSeconds);
  server.set_write_timeout(kTimeOutSeconds);
  server.set_keep_alive_timeout(kTimeOutSeconds);
  server.set_keep_alive_max_count(kRequestsPerConnection);

  const auto answer = [&api](const httplib::Request& request, httplib::Response& response) {
    put(api.answer(api_request(request)), response);
  };
  const std::string everything = ".*";
  server.Get(everything, answer);
  server.Post(everything, answer);
  server.Put(everything, answer);
  server.Patch(everything, answer);
  server.Delete(everything, answer);
  server.Options(everything, answer);
  server.set_error_handler([](const httplib::Request&, httplib::Response& response) {
    if (response.body.empty())
      put(error_response(response.status, text_of(response.status)), response);
  });

  if (port == 0) {
    state_->port = server.bind_to_any_port(host);
  } else {
    state_->port = server.bind_to_port(host, port) ? port : -1;
  }
  if (state_->port <= 0) {
    throw ListenError(cannot_listen_text(host, port));
  }
  state_->thread = std::thread([state = state_.get()] {
    if (!state->server.listen_after_bind()) log_error("http", "the server ended by itself");
  });
  // A server that does not run yet cannot be stopped: the destructor would wait for ever.
  const auto limit = std::chrono::steady_clock::now() + kStartLimit;
  while (!server.is_running() && std::chrono::steady_clock::now() < limit) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
}

HttpServer::~HttpServer() {
  state_->server.stop();
  state_->thread.join();
}

int HttpServer::port() const {
  return state_->port;
}

}  // namespace biotomy::acquisition
