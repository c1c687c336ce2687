#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/faults/fault.hpp"
#include "tests/faults/folder_content.hpp"
#include "tests/faults/small_sample.hpp"
#include "tests/integration/child_process.hpp"
#include "tests/temporary_folder.hpp"

namespace biotomy::tests {
namespace {

namespace fs = std::filesystem;

/// A sample of which a file is damaged. A section of it says which, and makes no picture.
class DamagedSample : public testing::Test {
 protected:
  DamagedSample() {
    write_small_images(folder_ / "images");
    const Outcome outcome = run(import_command(folder_ / "images", sample_), folder_.path());
    EXPECT_EQ(outcome.exit_code, 0) << outcome.errors;
  }

  Outcome section() const { return run(section_command(sample_, picture_), folder_.path()); }

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
  fs::path shard_ = volume_ / "0" / "c" / "0" / "1" / "0" / "0";
  fs::path picture_ = folder_ / "picture.png";
};

TEST_F(DamagedSample, AWholeOneGivesAPicture) {
  const Outcome outcome = section();
  EXPECT_EQ(outcome.exit_code, 0) << outcome.errors;
  EXPECT_TRUE(fs::exists(picture_));
}

TEST_F(DamagedSample, ATruncatedShardIsNamed) {
  truncate(shard_, {0.0, 0.01, 0.5, 0.99}, [&] { expect_refusal(section(), shard_); });
}

TEST_F(DamagedSample, AChangedByteOfAChunkOrOfTheIndexIsNoticed) {
  const std::string whole = read(shard_);
  for (const std::size_t place :
       {std::size_t{0}, std::size_t{30}, whole.size() - 30, whole.size() - 1}) {
    SCOPED_TRACE("byte " + std::to_string(place));
    std::string damaged = whole;
    damaged[place] = static_cast<char>(damaged[place] ^ 0x10);
    write(shard_, damaged);
    expect_refusal(section(), shard_);
  }
}

TEST_F(DamagedSample, MissingOrTruncatedMetadataIsNamed) {
  for (const fs::path& file :
       {volume_ / "zarr.json", volume_ / "0" / "zarr.json", sample_ / "sample.toml"}) {
    truncate(file, {0.0, 0.01, 0.5, 0.97}, [&] { expect_refusal(section(), file); });
    fs::rename(file, folder_ / "aside");
    expect_refusal(section(), file.filename());
    fs::rename(folder_ / "aside", file);
  }
  EXPECT_EQ(section().exit_code, 0);
}

TEST_F(DamagedSample, HostileMetadataIsNamedInOneLine) {
  const std::string deep(200'000, '[');
  const std::string huge = "{\"shape\": [3, 1e30, 9007199254740993, -1]}";
  for (const std::string& text :
       {deep, huge, std::string(3 << 20, ' '), std::string("{}"), std::string("\0\xff\n", 3)}) {
    for (const fs::path& file : {volume_ / "zarr.json", volume_ / "0" / "zarr.json"}) {
      const std::string whole = read(file);
      write(file, text);
      expect_refusal(section(), file);
      write(file, whole);
    }
  }
}

TEST_F(DamagedSample, AFileThatIsAFolderIsNamed) {
  fs::remove(shard_);
  fs::create_directory(shard_);
  expect_refusal(section(), shard_);
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

}  // namespace
}  // namespace biotomy::tests
