#include <algorithm>
#include <chrono>
#include <cmath>
#include <csignal>
#include <filesystem>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>
#include <opencv2/core.hpp>
#include <sys/time.h>

#include "reconstruct/errors.hpp"
#include "reconstruct/picture/image_file.hpp"
#include "tests/full_disk.hpp"
#include "tests/reconstruct/test_files.hpp"
#include "tests/reconstruct/test_images.hpp"
#include "tests/temporary_folder.hpp"
#include "tools/command.hpp"

namespace biotomy::tools {
namespace {

namespace fs = std::filesystem;

using reconstruct::InvalidRequest;
using reconstruct::message_of;
using reconstruct::names_in;
using reconstruct::read_file;
using reconstruct::read_image_file;
using reconstruct::SampleError;
using testing::HasSubstr;

nlohmann::json json_in(const fs::path& path) {
  const auto bytes = read_file(path);
  return nlohmann::json::parse(reinterpret_cast<const char*>(bytes.data()),
                               reinterpret_cast<const char*>(bytes.data()) + bytes.size());
}

/// SIGINT comes once, after the fiftieth part of a second of work.
class SignalSoon {
 public:
  SignalSoon() {
    std::signal(SIGPROF, [](int) { std::raise(SIGINT); });
    const itimerval soon{{0, 0}, {0, 20'000}};
    setitimer(ITIMER_PROF, &soon, nullptr);
  }
  ~SignalSoon() { std::signal(SIGPROF, SIG_DFL); }
  SignalSoon(const SignalSoon&) = delete;
  SignalSoon& operator=(const SignalSoon&) = delete;
};

/// Runs `biotomy` on a sample of 6 layers of 40 × 30 voxels of 10 × 10 × 20 µm.
class SectionAndSeries : public testing::Test {
 protected:
  SectionAndSeries() {
    const fs::path images = folder_ / "images";
    fs::create_directory(images);
    for (int i = 0; i < 6; ++i) {
      reconstruct::save_rgb(images / (std::to_string(i) + ".png"),
                            reconstruct::test_image(40, 30, CV_8UC3, static_cast<unsigned>(i)));
    }
    run({"import", images, "--spacing", "10,10,20", "-o", sample_});
  }

  static void run(std::vector<std::string> arguments) {
    CLI::App app;
    add_import_command(app);
    add_section_command(app);
    add_series_command(app);
    std::reverse(arguments.begin(), arguments.end());  // as CLI11 wants them
    app.parse(arguments);
  }

  void section(const fs::path& output, const std::vector<std::string>& more = {}) const {
    std::vector<std::string> words{"section",   sample_,  "--normal", "0,0,1",
                                   "--through", "0,0,40", "-o",       output};
    words.insert(words.end(), more.begin(), more.end());
    run(words);
  }

  void rotation(const fs::path& output, const std::vector<std::string>& more = {}) const {
    std::vector<std::string> words{"series", sample_,  "rotate", "--axis", "x",   "--to",
                                   "40",     "--step", "10",     "-o",     output};
    words.insert(words.end(), more.begin(), more.end());
    run(words);
  }

  tests::TemporaryFolder folder_;
  std::string sample_ = folder_ / "sample";
};

TEST_F(SectionAndSeries, ASectionIsTheSameInBothLosslessFormats) {
  section(folder_ / "a.png");
  section(folder_ / "a.tif");
  EXPECT_TRUE(reconstruct::same_pixels(read_image_file(folder_ / "a.png"),
                                       reconstruct::test_image(40, 30, CV_8UC3, 2)));
  EXPECT_TRUE(reconstruct::same_pixels(read_image_file(folder_ / "a.tif"),
                                       reconstruct::test_image(40, 30, CV_8UC3, 2)));
}

TEST_F(SectionAndSeries, AScaleBarLiesBelowTheSectionAndTheRecordKnows) {
  section(folder_ / "a.png");
  section(folder_ / "b.png", {"--scale-bar", "--json"});
  const cv::Mat plain = read_image_file(folder_ / "a.png");
  const cv::Mat with_bar = read_image_file(folder_ / "b.png");
  const nlohmann::json sidecar = json_in(folder_ / "b.json");
  EXPECT_EQ(sidecar.at("picture"),
            (nlohmann::json{{"width", with_bar.cols}, {"height", with_bar.rows}}));
  EXPECT_EQ(sidecar.at("parameters").at("scale-bar"), "true");
  const auto to_sample = sidecar.at("pixel_to_sample");
  const cv::Point first(static_cast<int>(-to_sample[0][2].get<double>() / 10.0),
                        static_cast<int>(-to_sample[1][2].get<double>() / 10.0));
  const cv::Rect part(first, plain.size());
  EXPECT_TRUE(reconstruct::same_pixels(with_bar(part), plain));
  EXPECT_EQ(cv::norm(with_bar.rowRange(part.br().y, with_bar.rows), cv::NORM_INF), 255.0);
}

TEST_F(SectionAndSeries, AScaleBarTakesLittleMemoryBesideAWidePicture) {
  section(folder_ / "a.png",
          {"--scale-bar", "--pixel", "0.004", "--theta", "custom:0,0,40,390,0.04,0"});
  const cv::Mat wide = read_image_file(folder_ / "a.png");
  EXPECT_EQ(wide.cols, 97'502);
  EXPECT_LT(wide.rows, 60);
}

TEST_F(SectionAndSeries, AScaleBarThatMakesAPictureTooLargeIsRefused) {
  const std::vector<std::string> wide{"--pixel", "0.00001", "--theta",
                                      "custom:0,0,40,390,0.00001,0", "--scale-bar"};
  EXPECT_THAT(message_of<SampleError>([&] { section(folder_ / "a.png", wide); }),
              HasSubstr("with its scale bar is too large for memory"));
  EXPECT_FALSE(fs::exists(folder_ / "a.png"));
}

TEST_F(SectionAndSeries, ASectionsPlaneCanBeTakenAgain) {
  run({"section", sample_, "--tilt", "33", "--azimuth", "77", "--json", "-o", folder_ / "a.png"});
  for (const char* record : {"a.png", "a.json"}) {
    run({"section", sample_, "--plane-of", folder_ / record, "-o", folder_ / "b.png"});
    EXPECT_TRUE(reconstruct::same_pixels(read_image_file(folder_ / "b.png"),
                                         read_image_file(folder_ / "a.png")));
  }
  EXPECT_THROW(section(folder_ / "c.png", {"--plane-of", folder_ / "a.json"}), InvalidRequest);
  EXPECT_THAT(
      message_of<SampleError>([&] {
        run({"section", sample_, "--plane-of", sample_ + "/sample.toml", "-o", folder_ / "c.png"});
      }),
      HasSubstr("sample.toml: does not say along which plane"));
}

TEST_F(SectionAndSeries, ARateWithoutAFilmIsAMistake) {
  EXPECT_THROW(rotation(folder_ / "frames", {"--rate", "5"}), CLI::RequiresError);
}

TEST_F(SectionAndSeries, AJpegIsSmallerAtALowerQuality) {
  section(folder_ / "a.jpg", {"--quality", "30"});
  section(folder_ / "b.jpg", {"--quality", "95"});
  EXPECT_LT(fs::file_size(folder_ / "a.jpg"), fs::file_size(folder_ / "b.jpg"));
  EXPECT_THROW(section(folder_ / "c.jpg", {"--quality", "0"}), InvalidRequest);
}

TEST_F(SectionAndSeries, TheSidecarSaysWhereThePixelsAre) {
  section(folder_ / "a.png", {"--json", "--pixel", "5"});
  const nlohmann::json sidecar = json_in(folder_ / "a.json");
  EXPECT_EQ(sidecar.at("sample").at("name"), "sample");
  EXPECT_EQ(sidecar.at("pixel_um"), 5.0);
  EXPECT_EQ(sidecar.at("pixel_to_sample"), nlohmann::json::parse("[[5,0,0],[0,5,0],[0,0,40]]"));
  EXPECT_EQ(sidecar.at("sample_to_pixel"),
            nlohmann::json::parse("[[0.2,0,0,0],[0,0.2,0,0],[0,0,1,-40]]"));
  EXPECT_EQ(sidecar.at("parameters").at("through"), "0,0,40");
  EXPECT_EQ(sidecar.at("parameters").at("pixel"), "5");

  const auto bytes = read_file(folder_ / "a.png");
  const std::string picture(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  EXPECT_THAT(picture, HasSubstr(sidecar.at("sample_to_pixel").dump()));
}

TEST_F(SectionAndSeries, APlaneMayBeALayer) {
  const fs::path picture = folder_ / "a.png";
  run({"section", sample_, "--layer", "3", "-o", picture});
  EXPECT_TRUE(reconstruct::same_pixels(read_image_file(picture),
                                       reconstruct::test_image(40, 30, CV_8UC3, 2)));
  const auto layer = [&](const std::string& number) {
    run({"section", sample_, "--layer", number, "-o", picture});
  };
  EXPECT_THAT(message_of<SampleError>([&] { layer("7"); }), HasSubstr("has layers 1 to 6"));
  EXPECT_THROW(layer("0"), InvalidRequest);
  EXPECT_THROW(layer("1.5"), InvalidRequest);
}

TEST_F(SectionAndSeries, APlaneMayBeGivenByItsAngles) {
  const auto plane = [&](const std::vector<std::string>& options) {
    std::vector<std::string> words{"section", sample_, "--json", "-o", folder_ / "a.png"};
    words.insert(words.end(), options.begin(), options.end());
    run(words);
    return json_in(folder_ / "a.json").at("plane");
  };
  // The sample's extent is 390 x 290 x 100 um.
  EXPECT_EQ(plane({"--tilt", "90"}), plane({"--normal", "1,0,0", "--through", "195,145,50"}));
  EXPECT_EQ(plane({"--tilt", "90", "--azimuth", "-90"}),
            plane({"--normal", "0,-1,0", "--through", "195,145,50"}));
  EXPECT_EQ(plane({"--tilt", "0", "--azimuth", "12"}),
            plane({"--normal", "0,0,1", "--through", "195,145,50"}));
  // As the page's explorer copies it as a command.
  EXPECT_EQ(plane({"--tilt", "30", "--azimuth", "75", "--through", "0,0,40"}),
            plane({"--normal", "0.12941,0.482963,0.866025", "--through", "0,0,40"}));
}

TEST_F(SectionAndSeries, APlaneIsGivenInOneWay) {
  for (const std::vector<std::string>& options : std::vector<std::vector<std::string>>{
           {},
           {"--through", "0,0,0"},
           {"--azimuth", "10"},
           {"--layer", "1", "--tilt", "10"},
           {"--layer", "1", "--through", "0,0,0"},
           {"--normal", "0,0,1", "--through", "0,0,0", "--tilt", "10"},
           {"--points", "0,0,0 1,0,0 0,1,0", "--layer", "1"},
           {"--tilt", "91"},
           {"--tilt", "10", "--azimuth", "181"}}) {
    std::vector<std::string> words{"section", sample_, "-o", folder_ / "a.png"};
    words.insert(words.end(), options.begin(), options.end());
    EXPECT_THROW(run(words), InvalidRequest) << testing::PrintToString(options);
  }
}

TEST_F(SectionAndSeries, ThreePointsNeedNoQuotes) {
  const fs::path quoted = folder_ / "quoted.png";
  const fs::path plain = folder_ / "plain.png";
  run({"section", "--points", "0,0,0 300,0,50 -10,200,70", sample_, "--json", "-o", quoted});
  run({"section", sample_, "--points", "0,0,0", "300,0,50", "-10,200,70", "--json", "-o", plain});
  EXPECT_TRUE(reconstruct::same_pixels(read_image_file(plain), read_image_file(quoted)));
  EXPECT_EQ(json_in(folder_ / "plain.json"), json_in(folder_ / "quoted.json"));
  EXPECT_EQ(message_of<InvalidRequest>([&] {
              run({"section", "--points", "0,0,0", "300,0,50", "0,200,70", sample_, "-o", plain});
            }),
            "The following arguments were not expected: 0,200,70 " + sample_ +
                "; put the three points into quotes: --points \"x,y,z x,y,z x,y,z\"");
  EXPECT_EQ(message_of<InvalidRequest>([&] {
              section(plain, {"--pixle", "3"});
            }),
            "The following arguments were not expected: --pixle 3");
}

TEST_F(SectionAndSeries, NothingIsWrittenIntoASample) {
  const fs::path layer = fs::path(sample_) / "layers/000003.tif";
  const auto before = read_file(layer);
  EXPECT_THAT(message_of<InvalidRequest>([&] { section(layer); }),
              HasSubstr("--output " + layer.string() + ": lies in the sample " + sample_));
  fs::create_symlink(fs::path(sample_) / "sample.toml", folder_ / "a.json");
  EXPECT_THAT(message_of<InvalidRequest>([&] { section(folder_ / "a.png", {"--json"}); }),
              HasSubstr("--json "));
  EXPECT_THROW(rotation(fs::path(sample_) / "turning"), InvalidRequest);
  EXPECT_THROW(rotation(folder_ / "turning", {"--movie", sample_ + "/turning.mp4"}),
               InvalidRequest);
  EXPECT_THROW(run({"import", folder_ / "images", "--spacing", "10,10,20", "-o",
                    fs::path(sample_) / "layers/again"}),
               InvalidRequest);
  EXPECT_EQ(read_file(layer), before);
  EXPECT_FALSE(fs::exists(folder_ / "a.png"));
  EXPECT_FALSE(fs::exists(folder_ / "turning"));
  EXPECT_FALSE(fs::exists(fs::path(sample_) / "turning"));
}

TEST_F(SectionAndSeries, NoSidecarIsWrittenUnlessAskedFor) {
  section(folder_ / "a.png");
  EXPECT_FALSE(fs::exists(folder_ / "a.json"));
}

TEST_F(SectionAndSeries, TheSidecarSaysWhichLevelsWereRead) {
  const auto levels_at = [&](const std::string& pixel) {
    section(folder_ / "a.png", {"--json", "--pixel", pixel});
    return json_in(folder_ / "a.json").at("levels").get<std::vector<int>>();
  };
  EXPECT_THAT(levels_at("10"), testing::ElementsAre(0));
  EXPECT_THAT(levels_at("15"), testing::ElementsAre(0, 1));
  EXPECT_THAT(levels_at("20"), testing::ElementsAre(1));
}

TEST_F(SectionAndSeries, LayersThatAreNotInTheVolumeYetAreInTheSection) {
  section(folder_ / "before.png");
  fs::remove_all(sample_ + "/volume.ome.zarr");
  section(folder_ / "after.png");
  EXPECT_TRUE(reconstruct::same_pixels(read_image_file(folder_ / "after.png"),
                                       read_image_file(folder_ / "before.png")));
  rotation(folder_ / "turning");
  EXPECT_EQ(json_in(folder_ / "turning/series.json").at("sample").at("layers"), 6);
}

TEST_F(SectionAndSeries, StatisticsAreOneLineOfJson) {
  testing::internal::CaptureStderr();
  section(folder_ / "a.png", {"--stats"});
  const auto line = nlohmann::json::parse(testing::internal::GetCapturedStderr());
  EXPECT_EQ(line.at("pixels"), 40 * 30);
  EXPECT_GT(line.at("section_s"), 0.0);
  EXPECT_GT(line.at("sample_s"), 0.0);
  EXPECT_GT(line.at("encode_s"), 0.0);
}

TEST_F(SectionAndSeries, ASignalEndsASectionAndLeavesTheOldPicture) {
  section(folder_ / "a.png");
  const auto before = read_file(folder_ / "a.png");
  const std::size_t files = names_in(folder_.path()).size();
  const std::string message = message_of<SampleError>([&] {
    const SignalSoon signal;
    section(folder_ / "a.png", {"--pixel", "0.05"});
  });
  EXPECT_THAT(message, testing::EndsWith("a.png: interrupted; the picture was not written"));
  EXPECT_EQ(read_file(folder_ / "a.png"), before);
  EXPECT_EQ(names_in(folder_.path()).size(), files);
}

TEST_F(SectionAndSeries, AFullDiskLeavesTheOldPicture) {
  const fs::path path = folder_ / "a.png";
  section(path);
  const auto before = read_file(path);
  {
    const tests::FullDisk full(500);
    EXPECT_THROW(section(path, {"--pixel", "1"}), SampleError);
  }
  EXPECT_EQ(read_file(path), before);
}

TEST_F(SectionAndSeries, WhatIsLostIsAnErrorUnlessItIsToleratedThenBackgroundAndAWarning) {
  const fs::path shard = fs::path(sample_) / "volume.ome.zarr/0/c/0/0/0/0";
  ASSERT_TRUE(fs::remove(shard));
  EXPECT_THAT(message_of<SampleError>([&] { section(folder_ / "a.png"); }),
              HasSubstr(shard.string() + ": is missing"));
  EXPECT_FALSE(fs::exists(folder_ / "a.png"));

  testing::internal::CaptureStderr();
  section(folder_ / "a.png", {"--tolerate-missing", "--background", "5,6,7"});
  const std::string warning = testing::internal::GetCapturedStderr();
  EXPECT_THAT(warning, testing::MatchesRegex("biotomy: [0-9]+ chunks? cannot be read .*\n"));
  EXPECT_THAT(warning, HasSubstr(shard.string() + ": is missing"));
  EXPECT_TRUE(reconstruct::same_pixels(read_image_file(folder_ / "a.png"),
                                       cv::Mat(30, 40, CV_8UC3, cv::Scalar(5, 6, 7))));

  testing::internal::CaptureStderr();
  rotation(folder_ / "turning", {"--tolerate-missing"});
  EXPECT_THAT(testing::internal::GetCapturedStderr(),
              testing::MatchesRegex("biotomy: [0-9]+ chunks? cannot be read .*\n"));
  EXPECT_EQ(names_in(folder_ / "turning").size(), 7U);  // damaged.json among them
}

TEST_F(SectionAndSeries, AWholeSampleGivesNoWarning) {
  testing::internal::CaptureStderr();
  section(folder_ / "a.png", {"--tolerate-missing"});
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

TEST_F(SectionAndSeries, ASeriesSaysWhatItIs) {
  rotation(folder_ / "turning");
  const nlohmann::json series = json_in(folder_ / "turning/series.json");
  EXPECT_EQ(series.at("sample").at("name"), "sample");
  EXPECT_EQ(series.at("sample").at("layers"), 6);
  EXPECT_EQ(series.at("parameters").at("command"), "rotate");
  EXPECT_EQ(series.at("unit"), "deg");
  ASSERT_EQ(series.at("frames").size(), 5U);
  EXPECT_EQ(series.at("frames")[1].at("value"), 10.0);
  EXPECT_EQ(series.at("frames")[1].at("file"), "001_+010.0deg.png");
  EXPECT_EQ(names_in(folder_ / "turning").size(), 6U);
}

TEST_F(SectionAndSeries, AFrameIsItsSectionAloneWhenNothingIsToStandBelow) {
  const fs::path layers = folder_ / "layers";
  const std::vector<std::string> words{"series", sample_, "translate", "--normal", "0,0,1",
                                       "--step", "20",    "-o",        layers};
  std::vector<std::string> bare = words;
  bare.insert(bare.end(), {"--no-label", "--no-scale-bar"});
  run(bare);
  const nlohmann::json series = json_in(layers / "series.json");
  EXPECT_TRUE(reconstruct::same_pixels(
      read_image_file(layers / series.at("frames")[2].at("file").get<std::string>()),
      reconstruct::test_image(40, 30, CV_8UC3, 2)));
  EXPECT_EQ(series.at("parameters").at("no-label"), "true");
  EXPECT_THAT(message_of<SampleError>([&] { run(words); }), HasSubstr("another series"));
}

TEST_F(SectionAndSeries, ASeriesIsTakenUpWhereItWasLeft) {
  const fs::path turning = folder_ / "turning";
  rotation(turning);
  const auto kept_since = fs::last_write_time(turning / "000_+000.0deg.png");
  const auto whole = read_file(turning / "003_+030.0deg.png");
  fs::remove(turning / "003_+030.0deg.png");
  reconstruct::truncate_file(turning / "004_+040.0deg.png", 0.5);
  rotation(turning, {"--movie", folder_ / "turning.mp4", "--rate", "10"});
  EXPECT_EQ(fs::last_write_time(turning / "000_+000.0deg.png"), kept_since);
  EXPECT_EQ(read_file(turning / "003_+030.0deg.png"), whole);
  EXPECT_NO_THROW(read_image_file(turning / "004_+040.0deg.png"));
  EXPECT_TRUE(fs::exists(folder_ / "turning.mp4"));
}

TEST_F(SectionAndSeries, AFilmIsTheSameWhateverFramesWereThere) {
  for (const std::string format : {"png", "jpg"}) {
    const std::string turning = folder_ / ("turning-" + format);
    const std::vector<std::string> more{"--format", format, "--quality", "10"};
    const auto with_film = [&](const fs::path& film) {
      std::vector<std::string> words = more;
      words.insert(words.end(), {"--movie", film});
      rotation(turning, words);
      return read_file(film);
    };
    const auto at_once = with_film(folder_ / ("a-" + format + ".mp4"));
    const auto frame = fs::path(turning) / ("002_+020.0deg." + format);
    const auto written = fs::last_write_time(frame);
    EXPECT_EQ(with_film(folder_ / ("b-" + format + ".mp4")), at_once) << format;
    EXPECT_EQ(fs::last_write_time(frame), written);
  }
}

TEST_F(SectionAndSeries, ASeriesOfASampleThatHasChangedSinceIsNotTakenUp) {
  rotation(folder_ / "turning");
  rotation(folder_ / "turning");
  const fs::path layer = fs::path(sample_) / "layers/000003.tif";
  fs::last_write_time(layer, fs::last_write_time(layer) + std::chrono::seconds(1));
  EXPECT_THAT(message_of<SampleError>([&] { rotation(folder_ / "turning"); }),
              testing::EndsWith("turning: the sample has changed since the frames in this folder "
                                "were cut: name a new folder, or remove this one"));
}

TEST_F(SectionAndSeries, AFolderOfAnotherSeriesIsRefused) {
  rotation(folder_ / "turning");
  EXPECT_THAT(message_of<SampleError>([&] {
                rotation(folder_ / "turning", {"--interpolation", "nearest"});
              }),
              HasSubstr("another series"));
}

TEST_F(SectionAndSeries, ASignalEndsASeriesBetweenTwoFramesAndItGoesOn) {
  const fs::path turning = folder_ / "turning";
  const std::string message = message_of<SampleError>([&] {
    const SignalSoon signal;
    run({"series", sample_, "rotate", "--axis", "x", "--to", "180", "--step", "0.05", "-o",
         turning});
  });
  EXPECT_THAT(message, HasSubstr("interrupted after "));
  EXPECT_THAT(message, HasSubstr("same command"));
  for (const std::string& name : names_in(turning)) {
    if (name != "series.json") {
      EXPECT_NO_THROW(read_image_file(turning / name)) << name;
    }
  }
}

TEST_F(SectionAndSeries, FramesSayWhereTheirPixelsAre) {
  rotation(folder_ / "turning");
  const fs::path path = folder_ / "turning/000_+000.0deg.png";
  const auto bytes = read_file(path);
  const std::string picture(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  const std::string key = "\"sample_to_pixel\":";
  const std::size_t begin = picture.find(key);
  ASSERT_NE(begin, std::string::npos);
  const std::size_t end = picture.find("]]", begin);
  const auto matrix =
      nlohmann::json::parse(picture.substr(begin + key.size(), end + 2 - begin - key.size()));
  const cv::Mat frame = read_image_file(path);
  // At 0 degrees the plane lies in the middle, z = 50 um: half-way between two layers.
  const int u = static_cast<int>(
      std::lround(matrix[0][0].get<double>() * 120.0 + matrix[0][3].get<double>()));
  const int v =
      static_cast<int>(std::lround(matrix[1][1].get<double>() * 70.0 + matrix[1][3].get<double>()));
  const cv::Vec3b above = reconstruct::test_image(40, 30, CV_8UC3, 2).at<cv::Vec3b>(7, 12);
  const cv::Vec3b below = reconstruct::test_image(40, 30, CV_8UC3, 3).at<cv::Vec3b>(7, 12);
  for (int c = 0; c < 3; ++c) {
    EXPECT_NEAR(frame.at<cv::Vec3b>(v, u)[c], (above[c] + below[c]) / 2.0, 0.5);
  }
}

TEST_F(SectionAndSeries, AFrameThatOnlyTouchesTheSampleSaysWhichPlaneItIs) {
  run({"series", sample_, "translate", "--normal", "1,1,4", "--step", "50", "-o",
       folder_ / "through"});
  const auto bytes = read_file(folder_ / "through/000_+000.0um.png");
  const std::string picture(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  const std::size_t begin = picture.find("{\"software\"");
  ASSERT_NE(begin, std::string::npos);
  const auto record =
      nlohmann::json::parse(picture.substr(begin, picture.find("}}", begin) + 2 - begin));
  EXPECT_EQ(record.at("plane").at("offset_um"), 0.0);
  EXPECT_EQ(record.at("polygon_um"), nlohmann::json::array());
  EXPECT_EQ(record.at("parameters").at("normal"), "1,1,4");
}

TEST_F(SectionAndSeries, FramesComeInTheFormatAskedFor) {
  rotation(folder_ / "a", {"--format", "tif"});
  rotation(folder_ / "b", {"--format", "jpg", "--movie", folder_ / "b.mp4"});
  EXPECT_TRUE(fs::exists(folder_ / "a/004_+040.0deg.tif"));
  EXPECT_TRUE(fs::exists(folder_ / "b/004_+040.0deg.jpg"));
  rotation(folder_ / "d", {"--format", "tiff"});
  rotation(folder_ / "e", {"--format", "jpeg"});
  const fs::path jpeg = folder_ / "e/004_+040.0deg.jpeg";
  EXPECT_TRUE(fs::exists(folder_ / "d/004_+040.0deg.tiff"));
  const auto written = fs::last_write_time(jpeg);
  rotation(folder_ / "e", {"--format", "jpeg"});
  EXPECT_EQ(fs::last_write_time(jpeg), written);
  EXPECT_THROW(rotation(folder_ / "c", {"--format", "bmp"}), InvalidRequest);
  EXPECT_FALSE(fs::exists(folder_ / "c"));
}

}  // namespace
}  // namespace biotomy::tools
