#include "reconstruct/section/film.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <opencv2/core.hpp>
#include <sys/wait.h>

#include "reconstruct/errors.hpp"
#include "tests/full_disk.hpp"
#include "tests/reconstruct/test_files.hpp"
#include "tests/temporary_folder.hpp"

namespace biotomy::reconstruct {
namespace {

using testing::HasSubstr;
using tests::TemporaryFolder;

constexpr int kFrames = 7;
const cv::Size kSize{160, 120};

cv::Mat frame_of(double red, double green, double blue) {
  return cv::Mat(kSize, CV_8UC3, cv::Scalar(red, green, blue));
}

/// What ffprobe says of the film's picture: "codec_name,width,height,pix_fmt,…".
std::string probed(const std::filesystem::path& path, const std::string& entries) {
  ChildProgram probe({"ffprobe", "-v", "error", "-count_frames", "-select_streams", "v:0",
                      "-show_entries", "stream=" + entries, "-of", "csv=p=0", path.string()});
  EXPECT_EQ(probe.finish(), 0) << probe.last_words();
  std::string words = probe.output();
  words.erase(words.find_last_not_of("\n,") + 1);
  return words;
}

/// The frames as a player shows them, R G B.
std::vector<cv::Mat> played(const std::filesystem::path& path, cv::Size size) {
  ChildProgram player({"ffmpeg", "-v", "error", "-i", path.string(), "-f", "rawvideo", "-pix_fmt",
                       "rgb24", "pipe:1"});
  EXPECT_EQ(player.finish(), 0) << player.last_words();
  const std::string bytes = player.output();
  const auto frame_bytes = static_cast<std::size_t>(size.area()) * 3;
  EXPECT_EQ(bytes.size() % frame_bytes, 0U);
  std::vector<cv::Mat> frames;
  for (std::size_t place = 0; place + frame_bytes <= bytes.size(); place += frame_bytes) {
    frames.push_back(cv::Mat(size, CV_8UC3, const_cast<char*>(bytes.data() + place)).clone());
  }
  return frames;
}

/// While one is alive, only this folder is searched for programs.
class ProgramsIn {
 public:
  explicit ProgramsIn(const std::filesystem::path& folder) : before_(std::getenv("PATH")) {
    setenv("PATH", folder.c_str(), 1);
  }
  ~ProgramsIn() { setenv("PATH", before_.c_str(), 1); }
  ProgramsIn(const ProgramsIn&) = delete;
  ProgramsIn& operator=(const ProgramsIn&) = delete;

 private:
  std::string before_;
};

void write_program(const std::filesystem::path& path, const std::string& script) {
  write_text(path, "#!/bin/sh\n" + script + '\n');
  std::filesystem::permissions(path, std::filesystem::perms::owner_all);
}

bool has_children() {
  return ::waitpid(-1, nullptr, WNOHANG) >= 0;
}

TEST(Film, HoldsEveryFrameInOrderAndItsColours) {
  const TemporaryFolder folder;
  const auto path = folder.path() / "a.mp4";
  Film film(path, 12.0, kSize);
  for (int i = 0; i < kFrames; ++i) {
    film.add(frame_of(30 * i, 100, 20));
  }
  film.finish();

  const std::vector<cv::Mat> frames = played(path, kSize);
  ASSERT_EQ(frames.size(), static_cast<std::size_t>(kFrames));
  for (int i = 0; i < kFrames; ++i) {
    const cv::Scalar mean = cv::mean(frames[static_cast<std::size_t>(i)]);
    EXPECT_NEAR(mean[0], 30 * i, 3.0);
    EXPECT_NEAR(mean[1], 100, 3.0);
    EXPECT_NEAR(mean[2], 20, 3.0);
  }
  EXPECT_EQ(names_in(folder.path()), std::vector<std::string>{"a.mp4"});
  EXPECT_FALSE(has_children());
}

TEST(Film, IsWhatBrowsersPlay) {
  const TemporaryFolder folder;
  const auto path = folder.path() / "a.mp4";
  Film film(path, 12.5, kSize);
  for (int i = 0; i < kFrames; ++i) {
    film.add(frame_of(30 * i, 100, 20));
  }
  film.finish();
  EXPECT_EQ(probed(path, "codec_name,width,height,pix_fmt"), "h264,160,120,yuv420p");
  EXPECT_EQ(probed(path, "color_range,color_space,color_transfer,color_primaries"),
            "tv,bt709,iec61966-2-1,bt709");
  EXPECT_EQ(probed(path, "r_frame_rate"), "25/2");
  EXPECT_EQ(probed(path, "avg_frame_rate"), "25/2");
  EXPECT_EQ(probed(path, "nb_read_frames"), "7");
  const auto bytes = read_file(path);
  const std::string text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  EXPECT_LT(text.find("moov"), text.find("mdat"));
}

TEST(Film, OfOneFrameIsAFilm) {
  const TemporaryFolder folder;
  Film film(folder.path() / "a.mp4", 25.0, kSize);
  film.add(frame_of(1, 2, 3));
  film.finish();
  EXPECT_EQ(probed(folder.path() / "a.mp4", "nb_read_frames"), "1");
}

TEST(Film, TakesFramesOf16Bits) {
  const TemporaryFolder folder;
  const auto path = folder.path() / "a.mp4";
  Film film(path, 25.0, kSize);
  film.add(cv::Mat(kSize, CV_16UC3, cv::Scalar(257 * 200, 257 * 100, 0)));
  film.finish();
  const auto frames = played(path, kSize);
  ASSERT_EQ(frames.size(), 1U);
  EXPECT_NEAR(cv::mean(frames[0])[0], 200.0, 3.0);
  EXPECT_NEAR(cv::mean(frames[0])[1], 100.0, 3.0);
}

TEST(Film, ReplacesAnOlderOneWhenItIsFinished) {
  const TemporaryFolder folder;
  const auto path = folder.path() / "a.mp4";
  write_text(path, "older");
  Film film(path, 25.0, kSize);
  film.add(frame_of(1, 2, 3));
  EXPECT_EQ(read_file(path).size(), 5U);
  film.finish();
  EXPECT_GT(read_file(path).size(), 5U);
}

TEST(Film, IsNotThereUntilItIsFinished) {
  const TemporaryFolder folder;
  {
    Film film(folder.path() / "a.mp4", 25.0, kSize);
    film.add(frame_of(1, 2, 3));
    EXPECT_FALSE(std::filesystem::exists(folder.path() / "a.mp4"));
  }
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
  EXPECT_FALSE(has_children());
}

// The encoder of a killed process may live for a moment longer and write on.
TEST(Film, ReplacesWhatAKilledProcessLeftAndDoesNotWriteIntoIt) {
  const TemporaryFolder folder;
  const TemporaryFolder other;
  write_text(folder.path() / ".a.mp4.partial", "half a film");
  std::filesystem::create_hard_link(folder.path() / ".a.mp4.partial", other.path() / "kept");
  Film film(folder.path() / "a.mp4", 25.0, kSize);
  film.add(frame_of(1, 2, 3));
  film.finish();
  EXPECT_EQ(names_in(folder.path()), std::vector<std::string>{"a.mp4"});
  EXPECT_EQ(read_file(other.path() / "kept").size(), std::string("half a film").size());
}

TEST(Film, IsWrittenByOneAtATime) {
  const TemporaryFolder folder;
  Film film(folder.path() / "a.mp4", 25.0, kSize);
  EXPECT_THAT(message_of<SampleError>([&] { Film(folder.path() / "a.mp4", 25.0, kSize); }),
              HasSubstr("another process"));
  film.add(frame_of(1, 2, 3));
  film.finish();
  EXPECT_TRUE(std::filesystem::exists(folder.path() / "a.mp4"));
}

TEST(Film, RefusesWhatIsNoFilm) {
  const TemporaryFolder folder;
  EXPECT_THROW(Film(folder.path() / "a.avi", 25.0, kSize), InvalidRequest);
  EXPECT_THROW(Film(folder.path() / "a.mp4", 0.0, kSize), InvalidRequest);
  EXPECT_THROW(Film(folder.path() / "a.mp4", std::nan(""), kSize), InvalidRequest);
  EXPECT_THROW(Film(folder.path() / "a.mp4", 25.0, cv::Size(161, 120)), InvalidRequest);
  EXPECT_THROW(Film(folder.path() / "a.mp4", 25.0, cv::Size(0, 0)), InvalidRequest);
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

TEST(Film, RefusesAFrameOfAnotherSizeOrType) {
  const TemporaryFolder folder;
  Film film(folder.path() / "a.mp4", 25.0, kSize);
  EXPECT_THROW(film.add(cv::Mat(100, 100, CV_8UC3, cv::Scalar())), InvalidRequest);
  for (const int type : {CV_8UC1, CV_8UC4, CV_32FC3}) {
    EXPECT_THROW(film.add(cv::Mat(kSize, type, cv::Scalar())), InvalidRequest) << type;
  }
}

TEST(Film, SaysThatThereIsNoFolderAndPrintsNothing) {
  const TemporaryFolder folder;
  testing::internal::CaptureStderr();
  EXPECT_THAT(
      message_of<SampleError>([&] { Film(folder.path() / "nowhere" / "a.mp4", 25.0, kSize); }),
      HasSubstr("no such folder"));
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

TEST(Film, SaysThatFfmpegIsNotInstalled) {
  const TemporaryFolder folder;
  const TemporaryFolder empty;
  const ProgramsIn programs(empty.path());
  EXPECT_THAT(message_of<SampleError>([&] { Film(folder.path() / "a.mp4", 25.0, kSize); }),
              HasSubstr("'ffmpeg' is not installed"));
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

TEST(Film, GivesTheWordsOfAnEncoderThatGivesUp) {
  const TemporaryFolder folder;
  const TemporaryFolder fake;
  write_program(fake.path() / "ffmpeg", "echo \"Unknown encoder 'libx264'\" >&2; exit 1");
  const ProgramsIn programs(fake.path());
  const std::string message = message_of<SampleError>([&] {
    Film film(folder.path() / "a.mp4", 25.0, kSize);
    for (int i = 0; i < 1000; ++i) {
      film.add(frame_of(1, 2, 3));
    }
    film.finish();
  });
  EXPECT_THAT(message, HasSubstr("a.mp4: ffmpeg failed"));
  EXPECT_THAT(message, HasSubstr("Unknown encoder 'libx264'"));
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
  EXPECT_FALSE(has_children());
}

TEST(Film, SaysThatTheEncoderWasKilled) {
  const TemporaryFolder folder;
  const TemporaryFolder fake;
  write_program(fake.path() / "ffmpeg", "kill -9 $$");
  const ProgramsIn programs(fake.path());
  EXPECT_THAT(message_of<SampleError>([&] {
                Film film(folder.path() / "a.mp4", 25.0, kSize);
                film.finish();
              }),
              HasSubstr("signal 9"));
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

TEST(Film, WithoutAllItsFramesIsNoFilm) {
  const TemporaryFolder folder;
  const TemporaryFolder fake;
  // An encoder that takes everything and reports success, and a file that lacks frames.
  write_program(fake.path() / "ffmpeg", "while read -r line; do :; done; exit 0");
  write_program(fake.path() / "ffprobe", "echo 1");
  const ProgramsIn programs(fake.path());
  EXPECT_THAT(message_of<SampleError>([&] {
                Film film(folder.path() / "a.mp4", 25.0, kSize);
                film.add(frame_of(1, 2, 3));
                film.add(frame_of(1, 2, 3));
                film.finish();
              }),
              HasSubstr("1 of its 2 frames"));
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

TEST(Film, LeavesTheOlderOneWhenTheDiskIsFull) {
  const TemporaryFolder folder;
  const auto path = folder.path() / "a.mp4";
  write_text(path, "older");
  {
    const tests::FullDisk full(2000);
    Film film(path, 25.0, kSize);
    EXPECT_THROW(
        {
          cv::RNG random(1);
          for (int i = 0; i < 60; ++i) {
            cv::Mat noise(kSize, CV_8UC3);
            random.fill(noise, cv::RNG::UNIFORM, 0, 256);
            film.add(noise);
          }
          film.finish();
        },
        SampleError);
  }
  EXPECT_EQ(names_in(folder.path()), std::vector<std::string>{"a.mp4"});
  EXPECT_EQ(read_file(path).size(), 5U);
}

TEST(FilmSize, IsTheFramesWherePlayersCanShowThem) {
  for (const cv::Size size : {cv::Size(2, 2), cv::Size(1920, 1080), cv::Size(4096, 2304)}) {
    EXPECT_EQ(film_size(size), size);
  }
}

TEST(FilmSize, IsEvenAndInProportionWhereTheFramesAreTooLarge) {
  for (const cv::Size size : {cv::Size(10'000, 10'000), cv::Size(9000, 100), cv::Size(100, 20'000),
                              cv::Size(4098, 2304)}) {
    const cv::Size smaller = film_size(size);
    EXPECT_EQ(smaller.width % 2 + smaller.height % 2, 0);
    EXPECT_LE((smaller.width + 15) / 16 * ((smaller.height + 15) / 16), 36864);
    EXPECT_LE(std::max(smaller.width, smaller.height), 543 * 16);
    const double shares = static_cast<double>(smaller.width) / size.width /
                          (static_cast<double>(smaller.height) / size.height);
    EXPECT_NEAR(shares, 1.0, 0.05);
    EXPECT_GT(smaller.width, 0.3 * size.width);  // 3072 of 10000 is what the square may have
  }
}

}  // namespace
}  // namespace biotomy::reconstruct
