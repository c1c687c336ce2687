// usb_camera: a USB camera as a program, for a kernel that has a USB port without wires.
#include <exception>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "tests/kernel/frame_source.hpp"
#include "tests/kernel/usb_camera.hpp"

namespace {

using biotomy::tests::FrameSize;

/// Of "640x480". Throws CLI::ValidationError.
FrameSize size_of(const std::string& text) {
  FrameSize size;
  const std::size_t cross = text.find('x');
  if (cross == std::string::npos || !CLI::detail::lexical_cast(text.substr(0, cross), size.width) ||
      !CLI::detail::lexical_cast(text.substr(cross + 1), size.height) || size.width < 1 ||
      size.height < 1) {
    throw CLI::ValidationError("--size", "'" + text + "' is no size; write it as 640x480");
  }
  return size;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("A USB camera as a program: unplugged when it ends.");
  std::vector<std::string> size_texts;
  std::string model = "Biotomy test camera";
  std::string folder;
  std::string socket;
  int frames_per_second = 30;
  app.add_option("--size", size_texts, "a frame size that it offers, such as 640x480")->required();
  app.add_option("--fps", frames_per_second, "frames a second, at most")->check(CLI::Range(1, 100));
  app.add_option("--model", model, "what it calls itself");
  auto* sources = app.add_option_group("source")->require_option(1);
  sources->add_option("--folder", folder, "shows the JPEG files in its folder 640x480, and so on");
  sources->add_option("--rig", socket, "shows what the camera behind a rig's socket sees");
  try {
    app.parse(argc, argv);
    std::vector<FrameSize> sizes;
    for (const std::string& text : size_texts) sizes.push_back(size_of(text));
    const std::unique_ptr<biotomy::tests::FrameSource> source =
        folder.empty() ? biotomy::tests::frames_of_rig(socket)
                       : biotomy::tests::frames_of_folder(folder);
    biotomy::tests::UsbCamera camera(sizes, frames_per_second, model, *source);
    std::cout << "usb_camera: plugged in" << std::endl;
    camera.run();
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  } catch (const std::exception& error) {
    std::cerr << "usb_camera: " << error.what() << '\n';
    return 1;
  }
}
