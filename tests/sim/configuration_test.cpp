#include "sim/service/configuration.hpp"

#include <fstream>
#include <sstream>

#include <gtest/gtest.h>

#include "tests/temporary_folder.hpp"

namespace biotomy::sim {
namespace {

constexpr const char* kLeast = R"(
[stage]
register_map = "register_map.toml"
[rig]
socket = "unix:///run/twin.sock"
)";

Configuration read(const std::string& text) {
  return read_configuration(bridge::CheckedTable::parse(text, "sim.toml"));
}

std::string refusal(const std::string& text) {
  try {
    read(text);
  } catch (const bridge::ConfigurationError& error) {
    return error.what();
  }
  return "";
}

TEST(Configuration, NeedsNoMoreThanTheMapAndTheSocket) {
  const Configuration c = read(kLeast);
  EXPECT_EQ(c.stage_listen.port, 1502);
  EXPECT_EQ(c.rig_socket, "/run/twin.sock");
  EXPECT_TRUE(c.state_file.empty());
  EXPECT_DOUBLE_EQ(c.phantom.width_um, 10000);
  EXPECT_DOUBLE_EQ(c.phantom.detail_um, 35);
  EXPECT_DOUBLE_EQ(c.rig.initial_face_um, c.first_face_um - 100);
}

TEST(Configuration, FitsThePhantomToTheCamerasView) {
  const Configuration c =
      read(std::string(kLeast) + "[camera]\nwidth = 400\nheight = 300\npixel = 20\n");
  EXPECT_DOUBLE_EQ(c.phantom.width_um, 8000);
  EXPECT_DOUBLE_EQ(c.phantom.height_um, 6000);
  EXPECT_DOUBLE_EQ(c.phantom.detail_um, 70);
  EXPECT_DOUBLE_EQ(c.rig.mechanics.face_width_um, 8000);
}

TEST(Configuration, PutsASerialLineBesideTheFile) {
  const tests::TemporaryFolder folder;
  std::ofstream(folder / "sim.toml")
      << "[stage]\nlisten = \"rtu://stage.line\"\nbaud = 115200\nregister_map = \"m\"\n[rig]\n"
         "socket = \"unix://x\"\n";
  const Configuration c = read_configuration(bridge::CheckedTable::read_file(folder / "sim.toml"));
  EXPECT_EQ(c.stage_listen.path, folder / "stage.line");
  EXPECT_EQ(c.stage_serial.baud, 115200);
}

TEST(Configuration, RefusesWhatIsMissingUnknownOrWrong) {
  EXPECT_NE(refusal("[rig]\nsocket = \"unix://x\"\n").find("register_map"), std::string::npos);
  EXPECT_NE(refusal("[stage]\nregister_map = \"m\"\n").find("socket"), std::string::npos);
  EXPECT_NE(refusal(std::string(kLeast) + "[camera]\nwitdh = 4\n").find("width"),
            std::string::npos);
  EXPECT_NE(refusal("time_scale = 0\n" + std::string(kLeast)).find("time_scale"),
            std::string::npos);
  EXPECT_NE(refusal("[stage]\nregister_map = \"m\"\nlisten = \"unix://x\"\n[rig]\nsocket = "
                    "\"unix://x\"\n")
                .find("tcp://host:port"),
            std::string::npos);
}

TEST(Configuration, IsDocumentedInTheReadme) {
  std::ifstream file(BIOTOMY_ROOT "/sim/README.md");
  std::ostringstream text;
  text << file.rdbuf();
  EXPECT_NE(text.str().find(configuration_reference()), std::string::npos)
      << "put this table into sim/README.md:\n"
      << configuration_reference();
}

}  // namespace
}  // namespace biotomy::sim
