#include "acquisition/viewer/volume_files.hpp"

#include <filesystem>
#include <fstream>
#include <string>

#include <gtest/gtest.h>

#include "tests/acquisition/viewer/part_content.hpp"
#include "tests/acquisition/viewer/viewed_sample.hpp"
#include "tests/file_content.hpp"
#include "tests/reconstruct/test_files.hpp"

namespace biotomy::acquisition {
namespace {

TEST(NamesOfAVolume, AreThoseOfItsStoreAlone) {
  for (const char* name : {"zarr.json", "0/zarr.json", "12/c/0/1/2/3"}) {
    EXPECT_TRUE(is_volume_name(name)) << name;
  }
  for (const char* name :
       {"", "/", ".", "..", "../sample.toml", "0", "0/", "0/c", "0/c/0/1/2", "0/c/0/1/2/3/4",
        "0/c/0/1/2/..", "c/0/0/0/0", "0//zarr.json", "0/c/zarr.json", "a/zarr.json", "0/c/0/0/0/-1",
        ".zarr.json.123-1", "0/c/0/0/0/0000000000", "0/d/0/0/0/0"}) {
    EXPECT_FALSE(is_volume_name(name)) << name;
  }
}

class FilesOfAVolume : public ViewedSample {
 protected:
  FilesOfAVolume() {
    add_layers(1, 40);
    make_volume(40);
  }

  ApiResponse get(const std::string& name, const std::string& range = {}) const {
    return api_.answer({.method = "GET", .path = "/volume.ome.zarr/" + name, .range = range});
  }
};

TEST_F(FilesOfAVolume, AreGivenWholeAndInParts) {
  const std::filesystem::path shard = sample_.volume_path() / "0/c/0/0/0/0";
  const std::uint64_t size = std::filesystem::file_size(shard);
  const ApiResponse whole = get("0/c/0/0/0/0");
  ASSERT_EQ(whole.status, 200) << whole.body;
  ASSERT_TRUE(whole.file);
  EXPECT_EQ(whole.file->bytes, size);
  EXPECT_EQ(tests::content_of(*whole.file), tests::content_of(shard));
  const ApiResponse part = get("0/c/0/0/0/0", "bytes=-20");
  EXPECT_EQ(part.status, 206);
  EXPECT_EQ(part.file->begin, size - 20);
  EXPECT_EQ(part.file->bytes, 20U);
  EXPECT_EQ(part.headers.at("Content-Range"), "bytes " + std::to_string(size - 20) + "-" +
                                                  std::to_string(size - 1) + "/" +
                                                  std::to_string(size));
  const ApiResponse beyond = get("0/c/0/0/0/0", "bytes=" + std::to_string(size) + "-");
  EXPECT_EQ(beyond.status, 416);
  EXPECT_EQ(beyond.headers.at("Content-Range"), "bytes */" + std::to_string(size));
  EXPECT_EQ(get("zarr.json").content_type, "application/json");
}

TEST_F(FilesOfAVolume, AreWhatTheyWereWhenTheyWereAskedFor) {
  const std::filesystem::path metadata = sample_.volume_path() / "zarr.json";
  const std::string before = tests::content_of(metadata);
  const ApiResponse asked = get("zarr.json");
  ASSERT_TRUE(asked.file);
  reconstruct::write_text(metadata.string() + ".new", "another one, written while that is sent");
  std::filesystem::rename(metadata.string() + ".new", metadata);
  EXPECT_EQ(tests::content_of(*asked.file), before);
  EXPECT_NE(get("zarr.json").headers.at("ETag"), asked.headers.at("ETag"));
}

TEST_F(FilesOfAVolume, AreGivenWholeToWhoHasTheBeginningOfAnother) {
  const std::string etag = get("0/c/0/0/0/0").headers.at("ETag");
  const auto status = [&](const std::string& if_range) {
    return api_
        .answer({.method = "GET",
                 .path = "/volume.ome.zarr/0/c/0/0/0/0",
                 .range = "bytes=100-",
                 .if_range = if_range})
        .status;
  };
  EXPECT_EQ(status(""), 206);
  EXPECT_EQ(status(etag), 206);
  EXPECT_EQ(status("\"another\""), 200);
  EXPECT_EQ(status("W/" + etag), 200) << "parts need the very same bytes";
}

TEST_F(FilesOfAVolume, AreNotThereWhereTheVolumeHasNone) {
  std::ofstream(folder_ / "secret") << "mine";
  std::filesystem::create_symlink(folder_ / "secret", sample_.volume_path() / "0/c/0/0/0/9");
  for (const char* name : {"0/c/0/0/0/9", "0/c/0/9/9/9", "../sample.toml", "9/zarr.json", ""}) {
    const ApiResponse response = get(name);
    EXPECT_EQ(response.status, 404) << name;
    EXPECT_FALSE(response.file) << name;
  }
}

TEST_F(FilesOfAVolume, AreNotSentTwice) {
  const std::string etag = get("zarr.json").headers.at("ETag");
  EXPECT_EQ(
      api_.answer({.method = "GET", .path = "/volume.ome.zarr/zarr.json", .if_none_match = etag})
          .status,
      304);
}

}  // namespace
}  // namespace biotomy::acquisition
