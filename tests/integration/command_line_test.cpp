#include <algorithm>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>
#include <httplib.h>
#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>

#include "tests/integration/child_process.hpp"
#include "tests/integration/listening_socket.hpp"
#include "tests/temporary_folder.hpp"

namespace biotomy::tests {
namespace {

namespace fs = std::filesystem;

constexpr int kFailure = 1;
constexpr int kUsage = 2;

/// The tool as a user meets it: exit codes and what stands on stderr.
class CommandLine : public testing::Test {
 protected:
  Outcome biotomy(const std::vector<std::string>& arguments) {
    std::vector<std::string> command{BIOTOMY_TOOL};
    command.insert(command.end(), arguments.begin(), arguments.end());
    return run(command, folder_.path());
  }

  /// Numbered images of one size, each a little brighter than the one before.
  fs::path numbered_images(int count) {
    const fs::path images = folder_.path() / "images";
    fs::create_directory(images);
    for (int i = 1; i <= count; ++i) {
      cv::imwrite(images / ("face" + std::to_string(i) + ".png"),
                  cv::Mat(48, 64, CV_8UC3, cv::Scalar(i, 2 * i, 3 * i)));
    }
    return images;
  }

  fs::path sample() {
    const fs::path path = folder_.path() / "sample";
    const Outcome outcome =
        biotomy({"import", numbered_images(40), "--spacing", "10,10,20", "-o", path});
    EXPECT_EQ(outcome.exit_code, 0) << outcome.errors;
    return path;
  }

  static void expect_one_line(const Outcome& outcome, int exit_code, const std::string& part) {
    EXPECT_EQ(outcome.exit_code, exit_code);
    EXPECT_EQ(std::count(outcome.errors.begin(), outcome.errors.end(), '\n'), 1) << outcome.errors;
    EXPECT_NE(outcome.errors.find(part), std::string::npos) << outcome.errors;
    EXPECT_EQ(outcome.output, "");
  }

  TemporaryFolder folder_;
};

TEST_F(CommandLine, PrintsItsVersionAndHelp) {
  EXPECT_EQ(biotomy({"--version"}).exit_code, 0);
  const Outcome help = biotomy({"--help"});
  EXPECT_EQ(help.exit_code, 0);
  for (const char* command : {"import", "info", "section", "series", "rig"}) {
    EXPECT_NE(help.output.find(command), std::string::npos) << command;
  }
}

TEST_F(CommandLine, ShowsASampleUntilItIsInterrupted) {
  const fs::path shown = sample();
  for (const int signal : {SIGINT, SIGTERM}) {
    ChildProcess view({BIOTOMY_TOOL, "view", shown, "--no-browser"}, folder_.path());
    const std::string address = view.wait_for("http://", std::chrono::seconds(60));
    httplib::Client client("http://" + address.substr(0, address.find('/')));
    EXPECT_EQ(client.Get("/")->status, 200);
    EXPECT_EQ(nlohmann::json::parse(client.Get("/api/v1/service")->body).at("kind"), "view");
    const auto section = client.Get("/api/v1/section?normal=0,0,1&through=0,0,0&format=png");
    EXPECT_EQ(section->status, 200);
    EXPECT_EQ(section->get_header_value("Content-Type"), "image/png");
    EXPECT_EQ(client.Get("/", {{"Host", "evil.example"}})->status, 421);
    view.send(signal);
    EXPECT_EQ(view.wait(std::chrono::seconds(60)).exit_code, 0);
  }
}

TEST_F(CommandLine, OpensABrowserThatGoesOnAfterCtrlC) {
  const fs::path browser = folder_ / "xdg-open";
  const fs::path seen = folder_ / "seen";
  // Its own number, its session's, and what it is to open.
  std::ofstream(browser) << "#!/bin/sh\necho $$ $(cut -d ' ' -f 6 /proc/$$/stat) $1 > '"
                         << (folder_ / "begun").string() << "'\nmv '"
                         << (folder_ / "begun").string() << "' '" << seen.string() << "'\n";
  fs::permissions(browser, fs::perms::owner_all);
  const std::string path = "PATH=" + folder_.path().string() + ":/usr/bin:/bin";
  ChildProcess view({"/usr/bin/env", path, "DISPLAY=:9", BIOTOMY_TOOL, "view", sample()},
                    folder_.path());
  const std::string address = view.wait_for("http://", std::chrono::seconds(60));
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(60);
  while (!fs::exists(seen) && std::chrono::steady_clock::now() < deadline) {
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  std::ifstream words(seen);
  pid_t process = 0;
  pid_t session = 0;
  std::string url;
  ASSERT_TRUE(words >> process >> session >> url);
  EXPECT_EQ(session, process);
  EXPECT_EQ(url, "http://" + address.substr(0, address.find(' ')));
  view.send(SIGINT);
  EXPECT_EQ(view.wait(std::chrono::seconds(60)).exit_code, 0);
}

TEST_F(CommandLine, ShowsASampleUnderTheNamesThatItWasGiven) {
  ChildProcess view(
      {BIOTOMY_TOOL, "view", "--host", "Knee.lab", "--host", "other.lab", sample(), "--no-browser"},
      folder_.path());
  const std::string address = view.wait_for("http://", std::chrono::seconds(60));
  httplib::Client client("http://" + address.substr(0, address.find('/')));
  EXPECT_EQ(client.Get("/", {{"Host", "knee.lab:8080"}})->status, 200);
  EXPECT_EQ(client.Get("/", {{"Host", "other.lab"}})->status, 200);
  const auto refused = client.Get("/", {{"Host", "third.lab"}});
  EXPECT_EQ(refused->status, 421);
  EXPECT_NE(refused->body.find("--host"), std::string::npos) << refused->body;
  view.send(SIGINT);
  EXPECT_EQ(view.wait(std::chrono::seconds(60)).exit_code, 0);
}

TEST_F(CommandLine, ShowsASampleToNoOtherComputerUnasked) {
  const fs::path shown = sample();
  expect_one_line(biotomy({"view", shown, "--listen", "0.0.0.0:0"}), kUsage, "--allow-remote");
  expect_one_line(biotomy({"view", shown, "--listen", "nowhere"}), kUsage, "--listen");
  expect_one_line(biotomy({"view", shown, "--host", "knee.lab:8080"}), kUsage, "--host");
  expect_one_line(biotomy({"view", folder_.path() / "none"}), kFailure, "none");
}

TEST_F(CommandLine, RefusesAnUnknownCommand) {
  expect_one_line(biotomy({"slice"}), kUsage, "slice");
}

TEST_F(CommandLine, ASectionAlongALayerIsThatLayer) {
  const fs::path picture = folder_.path() / "layer.png";
  const Outcome outcome = biotomy({"section", sample(), "--normal", "0,0,1", "--through", "0,0,32",
                                   "--unit", "voxel", "-o", picture});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.errors;
  const cv::Mat expected = cv::imread(folder_.path() / "images" / "face33.png");
  const cv::Mat image = cv::imread(picture);
  ASSERT_EQ(image.size(), expected.size());
  EXPECT_EQ(cv::norm(image, expected, cv::NORM_INF), 0.0);
}

TEST_F(CommandLine, RefusesAnImageOfAnotherSize) {
  const fs::path images = numbered_images(4);
  cv::imwrite(images / "face3.png", cv::Mat(48, 60, CV_8UC3, cv::Scalar(0)));
  const fs::path path = folder_.path() / "sample";
  expect_one_line(biotomy({"import", images, "--spacing", "10,10,20", "-o", path}), kFailure,
                  "face3.png");
  EXPECT_FALSE(fs::exists(path));
}

TEST_F(CommandLine, RefusesASequenceWithAMissingNumber) {
  const fs::path images = numbered_images(4);
  fs::remove(images / "face2.png");
  const fs::path path = folder_.path() / "sample";
  expect_one_line(biotomy({"import", images, "--spacing", "10,10,20", "-o", path}), kFailure, "2");
  EXPECT_FALSE(fs::exists(path));
}

TEST_F(CommandLine, RefusesATruncatedFile) {
  const fs::path images = numbered_images(4);
  fs::resize_file(images / "face3.png", fs::file_size(images / "face3.png") / 2);
  const fs::path path = folder_.path() / "sample";
  expect_one_line(biotomy({"import", images, "--spacing", "10,10,20", "-o", path}), kFailure,
                  "face3.png");
  EXPECT_FALSE(fs::exists(path));
}

TEST_F(CommandLine, LeavesASampleThatIsAlreadyThereAsItIs) {
  const fs::path path = sample();
  const auto before = fs::last_write_time(path / "sample.toml");
  expect_one_line(biotomy({"import", folder_.path() / "images", "--spacing", "1,1,1", "-o", path}),
                  kFailure, "sample");
  EXPECT_EQ(fs::last_write_time(path / "sample.toml"), before);
}

TEST_F(CommandLine, SaysThatAPlaneMisses) {
  const fs::path picture = folder_.path() / "none.png";
  expect_one_line(
      biotomy({"section", sample(), "--normal", "0,0,1", "--through", "0,0,5000", "-o", picture}),
      kFailure, "misses");
  EXPECT_FALSE(fs::exists(picture));
}

TEST_F(CommandLine, RefusesThreePointsOnALine) {
  expect_one_line(biotomy({"section", sample(), "--points", "0,0,0 10,10,10 20,20,20", "-o",
                           folder_.path() / "none.png"}),
                  kUsage, "line");
}

TEST_F(CommandLine, RefusesAPictureOfAnUnknownKindBeforeTheWork) {
  expect_one_line(biotomy({"section", sample(), "--normal", "0,0,1", "--through", "0,0,0", "-o",
                           folder_.path() / "none.bmp"}),
                  kUsage, "bmp");
}

TEST_F(CommandLine, SaysThatAFolderIsNotASample) {
  expect_one_line(biotomy({"info", folder_.path() / "nowhere"}), kFailure, "nowhere");
}

TEST_F(CommandLine, SaysThatNoDaemonAnswers) {
  expect_one_line(biotomy({"rig", "status", "--url", "http://127.0.0.1:9"}), kFailure,
                  "127.0.0.1:9");
}

TEST_F(CommandLine, QcJudgesAFolderOfImages) {
  const Outcome judged = biotomy({"qc", numbered_images(3)});
  EXPECT_EQ(judged.exit_code, 0) << judged.errors;
  EXPECT_NE(judged.output.find("3 frames: 0 accepted, 3 rejected"), std::string::npos)
      << judged.output;
  EXPECT_EQ(biotomy({"qc", folder_.path() / "images", "--strict"}).exit_code, kFailure);
}

TEST_F(CommandLine, QcAsksWhatToJudge) {
  expect_one_line(biotomy({"qc"}), kUsage, "--sweep");
  expect_one_line(biotomy({"qc", folder_.path() / "nowhere"}), kFailure, "nowhere");
}

TEST_F(CommandLine, AsksForACommand) {
  expect_one_line(biotomy({}), kUsage, "--help");
}

TEST_F(CommandLine, TheDaemonRefusesAnUnknownKeyAndNamesTheNearest) {
  const fs::path config = folder_.path() / "rig.toml";
  std::ofstream(config) << "[job]\nsample = \"s\"\nlayers = 3\nlayer_thickness_um = 20\n"
                           "pixel_um = [10, 10]\nfirst_face_um = 0\nsetle_ms = 5\n"
                           "[stage]\nendpoint = \"tcp://127.0.0.1:1502\"\n"
                           "[lines]\nendpoint = \"unix://s\"\n[camera]\nendpoint = \"unix://s\"\n"
                           "[focus]\nstart_um = 0\n";
  expect_one_line(run({BIOTOMY_DAEMON, "--config", config}, folder_.path()), kUsage, "settle_ms");
}

TEST_F(CommandLine, TheDaemonTakesAPolicyOfItsLadderOrSaysWhichThereAre) {
  expect_one_line(
      run({BIOTOMY_DAEMON, "--config", "rig.toml", "--qc-policy", "skip"}, folder_.path()), kUsage,
      "skip not in {pause,accept}");
  expect_one_line(
      run({BIOTOMY_DAEMON, "--config", "missing.toml", "--qc-policy", "accept"}, folder_.path()),
      kUsage, "missing.toml");
}

TEST_F(CommandLine, TheDaemonSuspectsAMisspeltKeyBehindAMissingOne) {
  const fs::path config = folder_.path() / "rig.toml";
  std::ofstream(config) << "[job]\nsample = \"s\"\nlayers = 3\nlayer_thicknes_um = 20\n";
  const Outcome outcome = run({BIOTOMY_DAEMON, "--config", config}, folder_.path());
  expect_one_line(outcome, kUsage, "layer_thickness_um");
  expect_one_line(outcome, kUsage, "layer_thicknes_um");
}

TEST_F(CommandLine, DaemonAndTwinSayThatTheirPortIsTaken) {
  const ListeningSocket taken;
  const fs::path sim = folder_.path() / "sim.toml";
  std::ofstream(sim) << "[stage]\nlisten = \"tcp://" << taken.address()
                     << "\"\nregister_map = \"" BIOTOMY_REGISTER_MAP
                        "\"\n[rig]\nsocket = \"unix://s\"\n";
  expect_one_line(run({BIOTOMY_TWIN, "--config", sim}, folder_.path()), kFailure, taken.address());

  const fs::path rig = folder_.path() / "rig.toml";
  std::ofstream(rig) << "[job]\nsample = \"s\"\nlayers = 3\nlayer_thickness_um = 20\n"
                        "pixel_um = [10, 10]\nfirst_face_um = 0\n[stage]\nendpoint = \"tcp://"
                     << taken.address() << "\"\nregister_map = \"" BIOTOMY_REGISTER_MAP
                     << "\"\n[lines]\nendpoint = \"unix://s\"\n[camera]\nendpoint = "
                        "\"unix://s\"\n[focus]\nstart_um = 0\n[service]\nlisten = \""
                     << taken.address() << "\"\n";
  expect_one_line(run({BIOTOMY_DAEMON, "--config", rig}, folder_.path()), kFailure,
                  taken.address());
}

TEST_F(CommandLine, TheTwinRefusesAnUnknownKeyAndNamesTheNearest) {
  const fs::path config = folder_.path() / "sim.toml";
  std::ofstream(config) << "time_scal = 20\n[stage]\nregister_map = \"r\"\n"
                           "[rig]\nsocket = \"unix://s\"\n";
  expect_one_line(run({BIOTOMY_TWIN, "--config", config}, folder_.path()), kUsage, "time_scale");
}

TEST_F(CommandLine, TheTwinRefusesAScenarioThatItDoesNotUnderstand) {
  const fs::path config = folder_.path() / "sim.toml";
  const fs::path scenario = folder_.path() / "scenario.toml";
  std::ofstream(config) << "[stage]\nregister_map = \"r\"\n[rig]\nsocket = \"unix://s\"\n";
  std::ofstream(scenario) << "about = \"a test\"\n[events.x]\nfault = \"dor_open\"\n";
  expect_one_line(run({BIOTOMY_TWIN, "--config", config, "--scenario", scenario}, folder_.path()),
                  kUsage, "door_open");
}

}  // namespace
}  // namespace biotomy::tests
