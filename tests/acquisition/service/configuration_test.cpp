#include "acquisition/service/configuration.hpp"

#include <fstream>
#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "acquisition/service/configuration_reference.hpp"
#include "firmware_bridge/wire/configuration_error.hpp"
#include "tests/temporary_folder.hpp"

namespace biotomy::tests {
namespace {

using namespace acquisition;
using testing::AllOf;
using testing::HasSubstr;
using testing::ThrowsMessage;

auto refuses(const std::string& part) {
  return ThrowsMessage<bridge::ConfigurationError>(HasSubstr(part));
}

/// The smallest configuration with one text in it replaced.
auto changed(const std::string& from, const std::string& to) {
  std::string text = smallest_configuration();
  const auto at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  text.replace(at, from.size(), to);
  return [text] { return parse_configuration(text, "rig.toml"); };
}

TEST(Configuration, TakesTheSmallestFileWithEveryDefault) {
  const Configuration read = parse_configuration(smallest_configuration(), "rig.toml");
  EXPECT_EQ(read.job.plan.layers, 1000);
  EXPECT_EQ(read.job.plan.name, "knee-042");
  EXPECT_EQ(read.job.plan.layer_thickness.value, 20.0);
  EXPECT_EQ(read.stage.endpoint, "tcp://127.0.0.1:1502");
  EXPECT_EQ(read.service.host, "127.0.0.1");
  EXPECT_EQ(read.service.port, 8080);
  EXPECT_EQ(read.service.tick, std::chrono::milliseconds(20));
  EXPECT_EQ(read.job.ladder.exhausted, LadderSettings::Exhausted::pause);
}

TEST(Configuration, RefusesAnUnknownKeyWithTheNearestKnownOne) {
  EXPECT_THAT(changed("layers = 1000", "layers = 1000\nspindel_rpm = 100"),
              refuses("job.spindel_rpm: unknown key; did you mean \"spindle_rpm\"?"));
}

TEST(Configuration, RefusesWhatIsMissingOrOutOfRange) {
  EXPECT_THAT(changed("layers = 1000\n", ""), refuses("job.layers: missing"));
  EXPECT_THAT(changed("layers = 1000", "layers = 0"), refuses("job.layers: 0 is out of range"));
  EXPECT_THAT(changed("layers = 1000", "layers = \"many\""), refuses("expected an integer"));
  EXPECT_THAT(changed("[10.0, 10.0]", "[10.0]"), refuses("an array of 2 numbers"));
}

TEST(Configuration, WantsTheLinesOfTheGpiodBackend) {
  EXPECT_THAT(changed("[lines]\nendpoint = \"unix://rig.sock\"", "[lines]\nbackend = \"gpiod\""),
              refuses("lines.estop.chip: missing"));
}

TEST(Configuration, TakesHowTheSafetyInputsAreWatched) {
  const auto lines = [](const std::string& debounce) {
    return changed("[lines]\nendpoint = \"unix://rig.sock\"",
                   "[lines]\nbackend = \"gpiod\"\n" + debounce +
                       "\nestop = { chip = \"rig\", line = \"ESTOP\" }\n"
                       "door = { chip = \"rig\", line = \"1\", edges = false }\n"
                       "lamp = { chip = \"rig\", line = \"LAMP\" }\n");
  };
  const bridge::GpiodLinesSettings read = lines("debounce_ms = 7")().lines.gpiod;
  EXPECT_EQ(read.debounce, std::chrono::milliseconds(7));
  EXPECT_TRUE(read.estop.edges);
  EXPECT_FALSE(read.door.edges);
  EXPECT_THAT(lines("debounce_ms = 101"), refuses("lines.debounce_ms: 101 is out of range"));
}

TEST(Configuration, WantsTheSocketOfTheSocketBackend) {
  EXPECT_THAT(changed("[camera]\nendpoint = \"unix://rig.sock\"", "[camera]"),
              refuses("camera.endpoint: missing"));
  EXPECT_THAT(changed("[camera]\nendpoint = \"unix://rig.sock\"",
                      "[camera]\nendpoint = \"tcp://1.2.3.4:5\""),
              refuses("expected \"unix://path\""));
}

TEST(Configuration, GivesTheTriggerToTheCameraThatIsSynchronised) {
  const std::string line = "[lines.trigger]\nchip = \"gpiochip0\"\nline = \"23\"\n";
  const auto with = [&](const std::string& camera, const std::string& lines) {
    return changed("[camera]\nendpoint = \"unix://rig.sock\"",
                   lines + "[camera]\nbackend = \"libcamera\"\n" + camera);
  };
  const Configuration free = with("", line)();
  EXPECT_EQ(free.camera.libcamera.sync.mode, bridge::CameraSyncSettings::Mode::none);
  EXPECT_TRUE(free.lines.gpiod.trigger);
  const Configuration synchronised = with("sync = \"strobe\"", line)();
  EXPECT_EQ(synchronised.camera.libcamera.sync.mode, bridge::CameraSyncSettings::Mode::strobe);
  EXPECT_EQ(synchronised.camera.libcamera.sync.line.line, "23");
  EXPECT_FALSE(synchronised.lines.gpiod.trigger);
  EXPECT_THAT(with("sync = \"trigger\"", ""), refuses("camera.sync: needs a line"));
  EXPECT_THAT(changed("[camera]", "[camera]\nsync = \"trigger\""),
              refuses("camera.sync: \"trigger\" is not possible"));
}

TEST(Configuration, RefusesACodecThatTheStoreDoesNotKnow) {
  EXPECT_THAT(changed("[focus]", "[store]\ncodec = \"gif\"\n[focus]"), refuses("store.codec"));
}

TEST(Configuration, TakesTheVolumesLayout) {
  const Configuration read =
      changed("[focus]",
              "[store]\ncodec = \"zstd1\"\ncolours = \"planar\"\nchunk = [64, 32, 16]\n"
              "shard = [512, 256, 16]\n[focus]")();
  const reconstruct::VolumeLayout layout{{16, 32, 64}, {16, 256, 512}, false, "zstd1"};
  EXPECT_EQ(read.job.store.volume_layout, layout);
}

TEST(Configuration, RefusesAShardThatIsNoMultipleOfItsChunk) {
  EXPECT_THAT(changed("[focus]", "[store]\nshard = [1000, 1024, 32]\n[focus]"),
              refuses("multiple of the chunk"));
}

TEST(Configuration, RefusesAPartOfAVoxel) {
  EXPECT_THAT(changed("[focus]", "[store]\nchunk = [32, 32, 1.5]\n[focus]"),
              refuses("store.chunk"));
}

TEST(Configuration, ListensToOtherComputersOnlyWhenThatIsMeant) {
  const auto service = [](const std::string& keys) {
    return changed("[focus]", "[service]\n" + keys + "\n[focus]");
  };
  for (const char* address : {"0.0.0.0:8080", "192.168.7.2:80", "[::]:8080", "rig.local:8080"}) {
    const std::string listen = std::string("listen = \"") + address + "\"";
    EXPECT_THAT(service(listen), refuses("service.allow_remote = true")) << address;
    EXPECT_NO_THROW(service(listen + "\nallow_remote = true")()) << address;
    EXPECT_TRUE(service(listen + "\nread = \"token\"")().service.access.reading_needs_token);
  }
  for (const char* address : {"127.0.0.1:80", "127.1.2.3:80", "localhost:80", "[::1]:80"}) {
    EXPECT_NO_THROW(service(std::string("listen = \"") + address + "\"")()) << address;
  }
}

TEST(Configuration, NamesWhoMayAskFromABrowser) {
  const auto service = [](const std::string& keys) {
    return changed("[focus]", "[service]\n" + keys + "\n[focus]");
  };
  const auto guard = service("hosts = [\"rig.lab\"]")().service.http.guard;
  EXPECT_THAT(guard.hosts, testing::ElementsAre("rig.lab"));
  EXPECT_EQ(guard.neuroglancer_origin, "https://neuroglancer-demo.appspot.com");
  EXPECT_EQ(service("neuroglancer = \"\"")().service.http.guard.neuroglancer_origin, "");
  for (const char* host : {"rig.lab:8080", "", "http://rig.lab"}) {
    EXPECT_THAT(service(std::string("hosts = [\"") + host + "\"]"), refuses("service.hosts"))
        << host;
  }
  for (const char* origin : {"neuroglancer.example", "https://a/b", "ftp://a", "https://"}) {
    EXPECT_THAT(service(std::string("neuroglancer = \"") + origin + "\""),
                refuses("service.neuroglancer"))
        << origin;
  }
}

TEST(Configuration, RefusesACaptureThatIsTooShortForItsExposure) {
  const auto camera = [](const std::string& keys) {
    return changed("[camera]", "[camera]\n" + keys);
  };
  EXPECT_NO_THROW(camera("exposure_us = 416666")());
  EXPECT_THAT(camera("exposure_us = 2000000"),
              refuses("camera.capture_timeout_ms: 5000 is too short for camera.exposure_us, which "
                      "is 2000000; expected at least 24000, twelve exposures"));
  EXPECT_NO_THROW(camera("exposure_us = 2000000\ncapture_timeout_ms = 24000")());
}

TEST(Configuration, RefusesAWheelThatWouldCountAsStandingWhileItGrinds) {
  const auto stands = [](const std::string& rpm) {
    return changed("[focus]", "[safety]\nwheel_stands_rpm = " + rpm + "\n[focus]");
  };
  EXPECT_NO_THROW(stands("166.0")());
  EXPECT_THAT(
      stands("200.0"),
      refuses("safety.wheel_stands_rpm: where it must stand, a wheel would count as turning "
              "only above 600 rpm, three times as much, and that must be at most a third of "
              "job.spindle_rpm, which is 1500"));
  EXPECT_THAT(changed("layers = 1000", "layers = 1000\nspindle_rpm = 40"),
              refuses("safety.wheel_stands_rpm"));
}

TEST(Configuration, RefusesToWaitForADeadControllerForMoreThanAMinute) {
  for (const std::string key : {"link_lost_ms", "controller_silent_ms", "command_start_ms"}) {
    const auto safety = [&](const std::string& time) {
      return changed("[focus]", "[safety]\n" + key + " = " + time + "\n[focus]");
    };
    EXPECT_NO_THROW(safety("60000")()) << key;
    EXPECT_THAT(safety("60001"), refuses("safety." + key + ": 60001 is out of range")) << key;
  }
}

TEST(Configuration, TellsNobodyUnlessItIsToldWhom) {
  EXPECT_FALSE(parse_configuration(smallest_configuration(), "rig.toml").notify.is_on());
  EXPECT_TRUE(changed("[focus]", "[notify]\ncommand = [\"mail\"]\n[focus]")().notify.is_on());
}

TEST(Configuration, RefusesAWebhookThatIsNoUrl) {
  for (const char* url : {"ftp://example.org", "example.org", "https://", "http://a b"}) {
    EXPECT_THAT(changed("[focus]", std::string("[notify]\nwebhook = \"") + url + "\"\n[focus]"),
                refuses("notify.webhook: must be a URL"))
        << url;
  }
  EXPECT_THAT(changed("[focus]", "[notify]\ncommand = [\"\"]\n[focus]"),
              refuses("notify.command: the first text must name the program"));
}

TEST(Configuration, ReadsTheExampleThatIsInstalled) {
  const Configuration read = read_configuration(BIOTOMY_EXAMPLE_CONFIGURATION);
  EXPECT_EQ(read.lines.backend, LinesConfiguration::Backend::gpiod);
  EXPECT_EQ(read.job.plan.layers, 4000);
}

TEST(Configuration, ReadsTheExamplesOfOtherRigs) {
  const std::filesystem::path folder = BIOTOMY_OTHER_EXAMPLES;
  const Configuration usb = read_configuration(folder / "tcp-controller-usb-camera.toml");
  EXPECT_THAT(usb.stage.endpoint, testing::StartsWith("tcp://"));
  EXPECT_EQ(usb.camera.backend, CameraConfiguration::Backend::libcamera);
  const Configuration csi = read_configuration(folder / "serial-controller-csi-camera.toml");
  EXPECT_THAT(csi.stage.endpoint, testing::StartsWith("rtu:///dev/serial/by-id/"));
  EXPECT_EQ(csi.job.focus.actuator, FocusSettings::Actuator::lens);
  const Configuration simulated = read_configuration(folder / "simulated-rig.toml");
  EXPECT_EQ(simulated.camera.backend, CameraConfiguration::Backend::socket);
  EXPECT_EQ(simulated.lines.backend, LinesConfiguration::Backend::socket);
}

TEST(Configuration, OfTheExamplesTakesABrokenWireForDanger) {
  const std::filesystem::path others = BIOTOMY_OTHER_EXAMPLES;
  for (const std::filesystem::path& file :
       {std::filesystem::path(BIOTOMY_EXAMPLE_CONFIGURATION),
        others / "tcp-controller-usb-camera.toml", others / "serial-controller-csi-camera.toml"}) {
    const Configuration read = read_configuration(file);
    for (const bridge::GpioLineSettings& line : {read.lines.gpiod.estop, read.lines.gpiod.door}) {
      EXPECT_EQ(line.bias, bridge::LineBias::pull_up) << file;
      EXPECT_FALSE(line.active_low) << file << ": a wire that broke, pulled up, must be active";
    }
  }
}

TEST(Configuration, FindsRelativePathsBesideItself) {
  const TemporaryFolder folder;
  std::ofstream(folder.path() / "rig.toml") << smallest_configuration();
  const Configuration read = read_configuration(folder.path() / "rig.toml");
  EXPECT_EQ(read.job.plan.sample, folder.path() / "knee-042");
  EXPECT_EQ(read.service.token_file, folder.path() / "biotomy.token");
  EXPECT_EQ(read.camera.endpoint, (folder.path() / "rig.sock").string());
}

TEST(Configuration, IsDescribedByItsPageWordForWord) {
  std::ifstream file(BIOTOMY_CONFIGURATION_PAGE);
  ASSERT_TRUE(file) << "there is no " BIOTOMY_CONFIGURATION_PAGE;
  std::ostringstream page;
  page << file.rdbuf();
  EXPECT_EQ(page.str(), configuration_reference())
      << "write it anew: biotomyd --configuration-reference > docs/configuration.md";
}

TEST(Configuration, TellsWhatEveryKeyMeans) {
  for (const bridge::DeclaredKey& key : known_keys()) {
    EXPECT_FALSE(key.description.empty()) << key.table << "." << key.name;
  }
}

}  // namespace
}  // namespace biotomy::tests
