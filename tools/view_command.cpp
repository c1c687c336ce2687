#include <array>
#include <chrono>
#include <cstdlib>
#include <iostream>
#include <memory>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include <fcntl.h>
#include <spawn.h>
#include <unistd.h>

#include "acquisition/http/event_feed.hpp"
#include "acquisition/http/http_server.hpp"
#include "acquisition/http/listen_address.hpp"
#include "acquisition/http/page.hpp"
#include "acquisition/http/request_guard.hpp"
#include "acquisition/log.hpp"
#include "acquisition/service/event_source.hpp"
#include "acquisition/service/sample_service.hpp"
#include "acquisition/viewer/sample_api.hpp"
#include "reconstruct/sample/sample_folder.hpp"
#include "tools/command.hpp"
#include "tools/interruption.hpp"

namespace biotomy::tools {
namespace {

using namespace acquisition;

constexpr std::chrono::milliseconds kLook{50};  // between two looks for a signal

struct ViewOptions {
  std::string sample;
  std::string listen = "127.0.0.1:0";
  std::vector<std::string> hosts;
  bool no_browser = false;
  bool allow_remote = false;
};

bool has_display() {
  const auto is_set = [](const char* name) {
    const char* value = std::getenv(name);
    return value != nullptr && *value != '\0';
  };
  return is_set("DISPLAY") || is_set("WAYLAND_DISPLAY");
}

/// Whoever has no xdg-open reads the address on the terminal.
void open_browser(const std::string& url) {
  std::string program = "xdg-open";
  std::string address = url;
  const std::array<char*, 3> words = {program.data(), address.data(), nullptr};
  posix_spawn_file_actions_t actions{};
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
  posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
  posix_spawnattr_t attributes{};
  posix_spawnattr_init(&attributes);
  // In a session of its own: Ctrl-C is for the server, not for a browser that begins with it.
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSID);
  pid_t process = 0;
  ::posix_spawnp(&process, program.c_str(), &actions, &attributes, words.data(), environ);
  posix_spawnattr_destroy(&attributes);
  posix_spawn_file_actions_destroy(&actions);
}

ListenAddress address_of(const ViewOptions& options) {
  const auto address = parse_listen_address(options.listen);
  if (!address) {
    throw std::invalid_argument("--listen: \"" + options.listen +
                                "\" is not possible; expected address:port");
  }
  if (!is_loopback(address->host) && !options.allow_remote) {
    throw std::invalid_argument("--listen: other computers reach " + address->host +
                                ", and everybody could see the sample there: add --allow-remote "
                                "if that is meant");
  }
  return *address;
}

void check_hosts(const ViewOptions& options) {
  for (const std::string& name : options.hosts) {
    if (!is_host_name(name)) {
      throw std::invalid_argument("--host: \"" + name +
                                  "\" is not possible; expected a name without a port");
    }
  }
}

void view(const ViewOptions& options) {
  const ListenAddress address = address_of(options);
  check_hosts(options);
  log_to_stderr();
  const auto folder = reconstruct::SampleFolder::open(options.sample);
  ViewerSettings viewer;
  viewer.journal = JournalReader::Journal::at_rest;
  viewer.threads = static_cast<int>(std::thread::hardware_concurrency());  // no run to make way for
  HttpSettings http;
  http.guard.hosts = options.hosts;
  const Page page(page_assets());
  EventFeed feed;
  SampleApi sample(std::filesystem::absolute(options.sample).lexically_normal(), viewer);
  sample.on_export([&feed](const std::string& json) { tell_export(feed, json); });
  const EventSource events(feed, {.status = {}, .sample = [&] { return sample.sample_event(); }});
  const SampleService service({.kind = ServiceDescription::Kind::view,
                               .reading_needs_token = false,
                               .commands_need_token = false,
                               .sample = folder.description().name,
                               .neuroglancer = http.guard.neuroglancer_origin},
                              page, sample, feed);
  const Interruption interruption;
  const HttpServer server(service, address.host, address.port, http);
  const std::string url = http_url(address.host, server.port()) + "/";
  std::cout << "the sample is shown at " << url << " until Ctrl-C" << std::endl;
  if (!options.no_browser && has_display()) open_browser(url);
  while (!Interruption::requested()) std::this_thread::sleep_for(kLook);
}

}  // namespace

void add_view_command(CLI::App& app) {
  auto options = std::make_shared<ViewOptions>();
  CLI::App* command = app.add_subcommand("view", "Shows a sample in a browser, without a rig.");
  command->add_option("sample", options->sample, "The sample's folder")->required();
  command
      ->add_option("--listen", options->listen,
                   "Address and port of the page; port 0 is any that is free")
      ->capture_default_str();
  command
      ->add_option("--host", options->hosts,
                   "A name by which browsers ask this computer, beside its address and its own "
                   "name; may be given several times")
      ->allow_extra_args(false);
  command->add_flag("--no-browser", options->no_browser, "Do not open a browser");
  command->add_flag("--allow-remote", options->allow_remote,
                    "Listen on an address that other computers reach");
  command->callback([options] { view(*options); });
}

}  // namespace biotomy::tools
