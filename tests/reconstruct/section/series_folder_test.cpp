#include "reconstruct/section/series_folder.hpp"

#include <filesystem>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <opencv2/core.hpp>

#include "reconstruct/errors.hpp"
#include "reconstruct/section/section_image.hpp"
#include "tests/reconstruct/test_files.hpp"
#include "tests/reconstruct/test_images.hpp"
#include "tests/temporary_folder.hpp"

namespace biotomy::reconstruct {
namespace {

using testing::HasSubstr;
using testing::UnorderedElementsAre;

const std::vector<std::string> kFrames{"000_+000.0deg.png", "001_+010.0deg.png"};
const nlohmann::ordered_json kDescription{{"step", 10}};
const cv::Size kSize{30, 20};

class SeriesFolderTest : public testing::Test {
 protected:
  SeriesFolder open(const nlohmann::ordered_json& description = kDescription) const {
    return SeriesFolder(path_, description, kFrames);
  }

  static void write_frame(SeriesFolder folder, std::size_t index, bool is_damaged = false) {
    folder.store(index, is_damaged, [](const std::filesystem::path& path) {
      write_section_image(path, test_image(kSize.width, kSize.height), {});
    });
  }

  tests::TemporaryFolder temporary_;
  std::filesystem::path path_ = temporary_ / "made" / "series";
};

TEST_F(SeriesFolderTest, IsMadeAndSaysWhatTheSeriesIs) {
  open();
  EXPECT_THAT(names_in(path_), UnorderedElementsAre("series.json"));
  const auto bytes = read_file(path_ / "series.json");
  EXPECT_EQ(nlohmann::ordered_json::parse(
                std::string(reinterpret_cast<const char*>(bytes.data()), bytes.size())),
            kDescription);
}

TEST_F(SeriesFolderTest, KeepsTheFramesOfTheSameSeries) {
  write_frame(open(), 1);
  const SeriesFolder again = open();
  EXPECT_FALSE(again.frame(0, kSize, CV_8UC3).has_value());
  const auto frame = again.frame(1, kSize, CV_8UC3);
  ASSERT_TRUE(frame.has_value());
  EXPECT_TRUE(same_pixels(*frame, test_image(kSize.width, kSize.height)));
}

TEST_F(SeriesFolderTest, DoesNotTakeADamagedFrameOrOneOfAnotherSizeForItsOwn) {
  write_frame(open(), 0);
  EXPECT_FALSE(open().frame(0, cv::Size(30, 22), CV_8UC3).has_value());
  EXPECT_FALSE(open().frame(0, kSize, CV_16UC3).has_value());
  EXPECT_TRUE(open().frame(0, kSize, CV_8UC3).has_value());
  truncate_file(path_ / kFrames[0], 0.5);
  EXPECT_FALSE(open().frame(0, kSize, CV_8UC3).has_value());
}

TEST_F(SeriesFolderTest, CutsFramesOfADamagedVolumeAgain) {
  write_frame(open(), 0, true);
  write_frame(open(), 1);
  EXPECT_FALSE(open().frame(0, kSize, CV_8UC3).has_value());
  EXPECT_TRUE(open().frame(1, kSize, CV_8UC3).has_value());
  write_frame(open(), 0);
  EXPECT_TRUE(open().frame(0, kSize, CV_8UC3).has_value());
  EXPECT_THAT(names_in(path_), UnorderedElementsAre("series.json", kFrames[0], kFrames[1]));
}

TEST_F(SeriesFolderTest, SaysThatItsListOfDamagedFramesIsNone) {
  open();
  write_text(path_ / "damaged.json", "{");
  EXPECT_THAT(message_of<SampleError>([&] { open(); }), HasSubstr("damaged.json: is no list"));
}

TEST_F(SeriesFolderTest, OfAnotherSeriesIsRefused) {
  write_frame(open(), 0);
  EXPECT_THAT(message_of<SampleError>([&] { open({{"step", 11}}); }), HasSubstr("another series"));
  EXPECT_TRUE(std::filesystem::exists(path_ / kFrames[0]));
}

TEST_F(SeriesFolderTest, WithForeignFilesIsRefused) {
  std::filesystem::create_directories(path_);
  write_text(path_ / "notes.txt", "mine");
  EXPECT_THAT(message_of<SampleError>([&] { open(); }), HasSubstr("not empty"));
  EXPECT_THAT(names_in(path_), UnorderedElementsAre("notes.txt"));

  std::filesystem::remove(path_ / "notes.txt");
  open();
  write_text(path_ / "002_+020.0deg.png", "of another series");
  EXPECT_THAT(message_of<SampleError>([&] { open(); }), HasSubstr("002_+020.0deg.png"));
}

TEST_F(SeriesFolderTest, MayHoldFilms) {
  std::filesystem::create_directories(path_);
  write_text(path_ / "a.mp4", "a film");
  write_text(path_ / ".b.mp4.partial", "half a film");
  open();
  open();
  EXPECT_THAT(names_in(path_), UnorderedElementsAre("series.json", "a.mp4", ".b.mp4.partial"));
}

TEST_F(SeriesFolderTest, RemovesWhatAKilledRunLeftHalfWritten) {
  std::filesystem::create_directories(path_);
  write_text(path_ / ".series.json.999999999-0", "{");
  write_text(path_ / ".001_+010.0deg.png.999999999-13", "half a frame");
  open();
  EXPECT_THAT(names_in(path_), UnorderedElementsAre("series.json"));
}

TEST_F(SeriesFolderTest, IsForOneAtATime) {
  const SeriesFolder folder = open();
  EXPECT_THAT(message_of<SampleError>([&] { open(); }), HasSubstr("another process"));
}

TEST_F(SeriesFolderTest, SaysThatItCannotBeMade) {
  write_text(temporary_ / "file", "");
  path_ = temporary_ / "file" / "series";
  EXPECT_THAT(message_of<SampleError>([&] { open(); }), HasSubstr("cannot create this folder"));
}

}  // namespace
}  // namespace biotomy::reconstruct
