// rig_cable: carries one service of a rig's socket over a serial line, from the computer at which
// the rig is to the one at which the socket is wanted. One client at a time. A frame is too much
// for the line: it goes by a file in a folder that both computers see.
#include <chrono>
#include <exception>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <optional>
#include <string>

#include <CLI/CLI.hpp>
#include <sys/stat.h>
#include <unistd.h>

#include "firmware_bridge/wire/rig_socket.hpp"
#include "firmware_bridge/wire/shared_frame.hpp"
#include "tests/kernel/cable.hpp"

namespace biotomy::tests {
namespace {

namespace fs = std::filesystem;
using bridge::RigConnection;
using bridge::RigPacket;
using bridge::RigSocketError;
using bridge::UniqueFd;

constexpr std::chrono::seconds kPatience(20);
constexpr std::chrono::hours kForEver(24);

/// A new file of `folder` with what is in memory.
std::string written(const UniqueFd& memory, const fs::path& folder) {
  static int count = 0;
  struct stat facts {};
  if (!memory.valid() || fstat(memory.get(), &facts) != 0) return "";
  const bridge::MappedFrame mapped(memory, static_cast<std::size_t>(facts.st_size));
  // Each by a name of its own: the other computer's kernel remembers what it has read.
  const fs::path file =
      folder / ("frame-" + std::to_string(getpid()) + "-" + std::to_string(count++));
  std::ofstream(file, std::ios::binary)
      .write(reinterpret_cast<const char*>(mapped.bytes().data()),
             static_cast<std::streamsize>(mapped.bytes().size()));
  return file;
}

/// Memory with what is in the file, which is removed.
UniqueFd taken(const std::string& file) {
  if (file.empty()) return UniqueFd();
  const auto size = fs::file_size(file);
  bridge::FrameMemory memory(size);
  std::ifstream(file, std::ios::binary)
      .read(reinterpret_cast<char*>(memory.bytes().data()), static_cast<std::streamsize>(size));
  fs::remove(file);
  return memory.seal();
}

/// At the rig: asks it what comes over the cable.
void ask_the_rig(const std::string& socket, const fs::path& folder) {
  const Cable cable = Cable::make();
  std::cout << "rig_cable: at " << cable.far_end().string() << std::endl;
  std::optional<RigConnection> rig;
  for (;;) {
    const CablePacket question = cable.receive();
    if (question.text.empty()) {
      rig.reset();
      continue;
    }
    CablePacket answer;
    try {
      if (!rig) rig = RigConnection::connect(socket, kPatience);
      rig->send(question.text, kPatience);
      const RigPacket packet = rig->receive(kPatience);
      answer = {.text = packet.text, .file = written(packet.descriptor, folder)};
    } catch (const RigSocketError&) {
      rig.reset();
      answer = {};
    }
    cable.send(answer);
  }
}

/// Passes on the questions of one client and the answers, until either is gone.
void serve(RigConnection& client, const Cable& cable) {
  cable.send({});
  for (;;) {
    cable.send({.text = client.receive(kForEver).text, .file = {}});
    const CablePacket answer = cable.receive();
    if (answer.text.empty()) return;
    client.send(answer.text, kPatience, taken(answer.file).get());
  }
}

/// At the other computer: is the rig.
void be_the_rig(const std::string& socket, const std::string& terminal) {
  const Cable cable = Cable::at(terminal);
  bridge::RigListener listener(socket);
  std::cout << "rig_cable: ready" << std::endl;
  for (;;) {
    std::optional<RigConnection> client = listener.accept(kForEver);
    if (!client) continue;
    try {
      serve(*client, cable);
    } catch (const RigSocketError&) {
      // It is gone; the next may come.
    }
  }
}

}  // namespace
}  // namespace biotomy::tests

int main(int argc, char** argv) {
  CLI::App app("Carries one service of a rig's socket over a serial line.");
  std::string rig;
  std::string socket;
  std::string folder;
  std::string terminal;
  auto* at_rig = app.add_option("--rig", rig, "the rig's socket; says where the line's end is");
  auto* wanted = app.add_option("--socket", socket, "a socket to be made, the rig's image");
  auto* line = app.add_option("--line", terminal, "the line's end at this computer");
  auto* shared = app.add_option("--folder", folder, "of the rig's frames, for both computers");
  at_rig->needs(shared);
  wanted->needs(line)->excludes(at_rig);
  try {
    app.parse(argc, argv);
    if (rig.empty() == socket.empty()) throw CLI::RequiredError("--rig or --socket");
    rig.empty() ? biotomy::tests::be_the_rig(socket, terminal)
                : biotomy::tests::ask_the_rig(rig, folder);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  } catch (const std::exception& error) {
    std::cerr << "rig_cable: " << error.what() << '\n';
    return 1;
  }
}
