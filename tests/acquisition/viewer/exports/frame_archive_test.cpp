#include "acquisition/viewer/exports/frame_archive.hpp"

#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "reconstruct/errors.hpp"
#include "tests/acquisition/viewer/exports/archive_content.hpp"
#include "tests/temporary_folder.hpp"

namespace biotomy::acquisition {
namespace {

std::span<const std::byte> bytes_of(const std::string& text) {
  return std::as_bytes(std::span(text));
}

TEST(AFrameArchive, HoldsTheFilesAsTheyAre) {
  const tests::TemporaryFolder folder;
  const std::string large(40'000'000, 'x');
  {
    FrameArchive archive(folder / "a.zip");
    archive.add("000_+000.0deg.png", bytes_of("first"));
    archive.add("001_+003.0deg.png", bytes_of(large));
    archive.add("002.png", {});
    archive.finish();
  }
  const auto files = archive_content(folder / "a.zip");
  ASSERT_EQ(files.size(), 3U);
  EXPECT_EQ(files[0], (std::pair<std::string, std::string>("000_+000.0deg.png", "first")));
  EXPECT_EQ(files[1].second, large);
  EXPECT_EQ(files[2].second, "");
  EXPECT_GT(std::filesystem::file_size(folder / "a.zip"), large.size()) << "stored, not deflated";
}

TEST(AFrameArchive, SaysWhereItCannotBeWritten) {
  EXPECT_THROW(FrameArchive("/nowhere/a.zip"), reconstruct::SampleError);
}

}  // namespace
}  // namespace biotomy::acquisition
