#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>

#include "tests/faults/fault.hpp"
#include "tests/faults/folder_content.hpp"
#include "tests/faults/small_sample.hpp"
#include "tests/integration/child_process.hpp"
#include "tests/temporary_folder.hpp"

namespace biotomy::tests {
namespace {

namespace fs = std::filesystem;

/// A sample of which a file is damaged. A section of it says which, and makes no picture, or, when
/// that is tolerated, one with background in the place of what is damaged.
class DamagedSample : public testing::Test {
 protected:
  DamagedSample() {
    write_small_images(folder_ / "images");
    const Outcome outcome = run(import_command(folder_ / "images", sample_), folder_.path());
    EXPECT_EQ(outcome.exit_code, 0) << outcome.errors;
  }

  /// A shard of the level in the middle of the picture.
  fs::path shard(int level) const {
    return volume_ / std::to_string(level) / "c" / "0" / "1" / "0" / "0";
  }

  Outcome section(int level, bool tolerant) const {
    std::vector<std::string> command = section_command(sample_, picture_, level);
    if (tolerant) command.emplace_back("--tolerate-missing");
    return run(command, folder_.path());
  }

  void expect_warning(const Outcome& outcome, const fs::path& file) const {
    EXPECT_EQ(outcome.exit_code, 0);
    EXPECT_EQ(std::count(outcome.errors.begin(), outcome.errors.end(), '\n'), 1) << outcome.errors;
    EXPECT_NE(outcome.errors.find(" cannot be read "), std::string::npos) << outcome.errors;
    EXPECT_NE(outcome.errors.find(file.string()), std::string::npos) << outcome.errors;
  }

  /// Of the level's shard(), which is damaged.
  void expect_refusal_or_background(int level) const {
    expect_refusal(section(level, false), shard(level));
    expect_warning(section(level, true), shard(level));
    EXPECT_TRUE(fs::remove(picture_));
  }

  void expect_refusal(const Outcome& outcome, const fs::path& file) const {
    EXPECT_EQ(outcome.exit_code, 1);
    EXPECT_EQ(std::count(outcome.errors.begin(), outcome.errors.end(), '\n'), 1) << outcome.errors;
    EXPECT_NE(outcome.errors.find(file.string()), std::string::npos) << outcome.errors;
    EXPECT_FALSE(fs::exists(picture_));
  }

  static std::string read(const fs::path& file) {
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
  }
  static void write(const fs::path& file, const std::string& bytes) {
    std::ofstream(file, std::ios::binary) << bytes;
  }

  /// Calls `check` with the file cut to each of these shares of its length.
  template <typename Check>
  static void truncate(const fs::path& file, const std::vector<double>& shares, Check&& check) {
    const std::string whole = read(file);
    for (const double share : shares) {
      SCOPED_TRACE("cut to " + std::to_string(share));
      write(file,
            whole.substr(0, static_cast<std::size_t>(share * static_cast<double>(whole.size()))));
      check();
    }
    write(file, whole);
  }

  TemporaryFolder folder_;
  fs::path sample_ = folder_ / "sample";
  fs::path volume_ = sample_ / "volume.ome.zarr";
  fs::path picture_ = folder_ / "picture.png";
};

TEST_F(DamagedSample, AWholeOneGivesAPictureWithoutAWord) {
  for (const int level : {0, 1}) {
    for (const bool tolerant : {false, true}) {
      const Outcome outcome = section(level, tolerant);
      EXPECT_EQ(outcome.exit_code, 0) << outcome.errors;
      EXPECT_EQ(outcome.errors, "");
      EXPECT_TRUE(fs::remove(picture_));
    }
  }
}

TEST_F(DamagedSample, AMissingShardIsNamedOrTolerated) {
  for (const int level : {0, 1}) {
    SCOPED_TRACE("level " + std::to_string(level));
    fs::rename(shard(level), folder_ / "aside");
    expect_refusal_or_background(level);
    fs::rename(folder_ / "aside", shard(level));
  }
}

TEST_F(DamagedSample, ATruncatedShardIsNamedOrTolerated) {
  for (const int level : {0, 1}) {
    SCOPED_TRACE("level " + std::to_string(level));
    truncate(shard(level), {0.0, 0.01, 0.5, 0.99}, [&] { expect_refusal_or_background(level); });
  }
}

TEST_F(DamagedSample, AChangedByteOfAChunkOrOfTheIndexIsNamedOrTolerated) {
  for (const int level : {0, 1}) {
    SCOPED_TRACE("level " + std::to_string(level));
    const std::string whole = read(shard(level));
    for (const std::size_t place :
         {std::size_t{0}, std::size_t{30}, whole.size() - 30, whole.size() - 1}) {
      SCOPED_TRACE("byte " + std::to_string(place));
      std::string damaged = whole;
      damaged[place] = static_cast<char>(damaged[place] ^ 0x10);
      write(shard(level), damaged);
      expect_refusal_or_background(level);
    }
    write(shard(level), whole);
  }
}

TEST_F(DamagedSample, AShardThatIsAFolderIsNamedOrTolerated) {
  for (const int level : {0, 1}) {
    fs::remove(shard(level));
    fs::create_directory(shard(level));
    expect_refusal_or_background(level);
  }
}

TEST_F(DamagedSample, ToleratedDamageCostsNoMoreOfThePictureThanItsChunks) {
  const Outcome whole = section(0, false);
  ASSERT_EQ(whole.exit_code, 0) << whole.errors;
  const cv::Mat expected = cv::imread(picture_.string());
  fs::remove(shard(0));  // of layers 3 and 4, x up to 31
  ASSERT_EQ(section(0, true).exit_code, 0);
  const cv::Mat found = cv::imread(picture_.string());
  ASSERT_EQ(found.size(), expected.size());
  int background = 0;
  for (int y = 0; y < found.rows; ++y) {
    for (int x = 0; x < found.cols; ++x) {
      const bool is_background = found.at<cv::Vec3b>(y, x) == cv::Vec3b(0, 0, 0);
      background += is_background ? 1 : 0;
      if (x >= 33 || y < found.rows / 5) {
        EXPECT_EQ(found.at<cv::Vec3b>(y, x), expected.at<cv::Vec3b>(y, x)) << x << ", " << y;
      }
    }
  }
  EXPECT_GT(background, 100);
}

TEST_F(DamagedSample, ToleratedDamageLetsASeriesBeWhole) {
  fs::remove(shard(0));
  const fs::path frames = folder_ / "frames";
  std::vector<std::string> series{BIOTOMY_TOOL, "series", sample_, "rotate", "--axis",
                                  "x",          "--step", "60",    "-o",     frames};
  const Outcome refused = run(series, folder_.path());
  EXPECT_EQ(refused.exit_code, 1);
  EXPECT_NE(refused.errors.find(shard(0).string()), std::string::npos) << refused.errors;
  fs::remove_all(frames);
  series.emplace_back("--tolerate-missing");
  expect_warning(run(series, folder_.path()), shard(0));
  EXPECT_TRUE(fs::exists(frames / "003_+180.0deg.png"));

  expect_warning(run(series, folder_.path()), shard(0));  // nor is it silent the second time
  const FolderContent damaged = content_of_folder(frames);
  ASSERT_EQ(run({BIOTOMY_TOOL, "rebuild", sample_}, folder_.path()).exit_code, 0);
  const Outcome mended = run(series, folder_.path());
  EXPECT_EQ(mended.exit_code, 0);
  EXPECT_EQ(mended.errors, "");
  EXPECT_NE(content_of_folder(frames), damaged);
  EXPECT_FALSE(fs::exists(frames / "damaged.json"));
}

TEST_F(DamagedSample, VerifyNamesAShardThatIsMissingAtAnyLevelAndRebuildBringsItBack) {
  const FolderContent before = content_of_folder(volume_);
  for (const int level : {0, 1}) fs::remove(shard(level));
  const Outcome verified = run({BIOTOMY_TOOL, "verify", sample_}, folder_.path());
  EXPECT_EQ(verified.exit_code, 1);
  for (const int level : {0, 1}) {
    const std::string name = fs::relative(shard(level), sample_).string();
    EXPECT_NE((verified.output + verified.errors).find(name), std::string::npos)
        << verified.output << verified.errors;
  }
  EXPECT_EQ(run({BIOTOMY_TOOL, "rebuild", sample_}, folder_.path()).exit_code, 0);
  EXPECT_EQ(content_of_folder(volume_), before);
}

TEST_F(DamagedSample, MissingOrTruncatedMetadataOfAnyLevelIsNamedAndNeverTolerated) {
  for (const fs::path& file :
       {volume_ / "zarr.json", volume_ / "0" / "zarr.json", volume_ / "1" / "zarr.json"}) {
    const auto expect_named = [&] {
      for (const int level : {0, 1}) {
        for (const bool tolerant : {false, true}) {
          expect_refusal(section(level, tolerant), file);
        }
      }
    };
    truncate(file, {0.0, 0.01, 0.5, 0.97}, expect_named);
    fs::rename(file, folder_ / "aside");
    expect_named();
    fs::rename(folder_ / "aside", file);
  }
  EXPECT_EQ(section(0, false).exit_code, 0);
}

TEST_F(DamagedSample, AMissingOrTruncatedDescriptionIsNamed) {
  const fs::path file = sample_ / "sample.toml";
  truncate(file, {0.0, 0.01, 0.5, 0.97}, [&] { expect_refusal(section(0, false), file); });
  fs::remove(file);
  expect_refusal(section(0, true), file.filename());
}

TEST_F(DamagedSample, HostileMetadataIsNamedInOneLine) {
  const std::string deep(200'000, '[');
  const std::string huge = "{\"shape\": [3, 1e30, 9007199254740993, -1]}";
  for (const std::string& text :
       {deep, huge, std::string(3 << 20, ' '), std::string("{}"), std::string("\0\xff\n", 3)}) {
    for (const fs::path& file :
         {volume_ / "zarr.json", volume_ / "0" / "zarr.json", volume_ / "1" / "zarr.json"}) {
      const std::string whole = read(file);
      write(file, text);
      expect_refusal(section(0, false), file);
      write(file, whole);
    }
  }
}

TEST_F(DamagedSample, ADiskThatCannotReadIsNamedWithTheFile) {
  const fs::path counts = folder_ / "counts";
  ASSERT_EQ(
      run(under({volume_}, section_command(sample_, picture_), counts), folder_.path()).exit_code,
      0);
  fs::remove(picture_);
  std::int64_t reads = 0;
  std::ifstream in(counts);
  for (std::string name; in >> name;) {
    std::int64_t count = 0;
    in >> count;
    reads = name == "read" ? count : reads;
  }
  ASSERT_GT(reads, 5);
  for (std::int64_t at = 1; at <= reads; ++at) {
    SCOPED_TRACE("read " + std::to_string(at));
    expect_refusal(run(under({.folder = volume_, .call = "read", .at = at, .error = "EIO"},
                             section_command(sample_, picture_)),
                       folder_.path()),
                   volume_);
  }
}

TEST_F(DamagedSample, AMissingTruncatedOrChangedLayerIsNamedAndTheVolumeStaysAsItWas) {
  fs::remove_all(volume_);
  ASSERT_EQ(run({BIOTOMY_APPEND_LAYERS, sample_, "2"}, folder_.path()).exit_code, 0);
  const FolderContent before = content_of_folder(volume_);
  const fs::path layer = sample_ / "layers" / "000004.tif";
  const auto check = [&] {
    expect_refusal(run({BIOTOMY_APPEND_LAYERS, sample_, "5"}, folder_.path()), layer);
    const FolderContent after = content_of_folder(volume_);
    for (const auto& [name, bytes] : before) {
      EXPECT_TRUE(after.contains(name) && after.at(name) == bytes) << name;
    }
  };
  // At its end a TIFF has its tags; without the last of them its pixels are still whole.
  truncate(layer, {0.0, 0.01, 0.5}, check);
  std::string changed = read(layer);
  changed[20] = static_cast<char>(changed[20] ^ 0x10);
  write(layer, changed);
  check();
  fs::remove(layer);
  check();
}

TEST_F(DamagedSample, ARebuildNamesADamagedLayerAndLeavesTheVolume) {
  const FolderContent before = content_of_folder(volume_);
  const fs::path layer = sample_ / "layers" / "000004.tif";
  const auto check = [&] {
    expect_refusal(run({BIOTOMY_TOOL, "rebuild", sample_}, folder_.path()), layer);
    EXPECT_EQ(content_of_folder(volume_), before);
  };
  truncate(layer, {0.0, 0.01, 0.5}, check);
  fs::rename(layer, folder_ / "aside");
  check();
}

}  // namespace
}  // namespace biotomy::tests
