#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <zlib.h>

#include "acquisition/http/page_asset.hpp"

namespace biotomy::tests {
namespace {

using namespace acquisition;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

/// What a gzip file holds; its check sum is looked at, too.
std::string unpacked(std::string_view gzip) {
  z_stream stream{};
  EXPECT_EQ(inflateInit2(&stream, 15 + 16), Z_OK);
  std::string text(64, '\0');
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(gzip.data()));
  stream.avail_in = static_cast<uInt>(gzip.size());
  int result = Z_OK;
  while (result == Z_OK) {
    if (stream.total_out == text.size()) text.resize(2 * text.size());
    stream.next_out = reinterpret_cast<Bytef*>(text.data() + stream.total_out);
    stream.avail_out = static_cast<uInt>(text.size() - stream.total_out);
    result = inflate(&stream, Z_NO_FLUSH);
  }
  EXPECT_EQ(result, Z_STREAM_END);
  EXPECT_EQ(stream.avail_in, 0U);
  text.resize(stream.total_out);
  inflateEnd(&stream);
  return text;
}

std::string content(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  EXPECT_TRUE(stream) << file;
  return {std::istreambuf_iterator<char>(stream), {}};
}

std::string the_page() {
  const auto assets = page_assets();
  const auto found = std::find_if(assets.begin(), assets.end(), [](const PageAsset& asset) {
    return asset.path == "/index.html";
  });
  return found == assets.end() ? "" : unpacked(found->gzip);
}

TEST(PageAssets, AreTheFilesThatWereBuiltByteForByte) {
  ASSERT_FALSE(page_assets().empty());
  for (const PageAsset& asset : page_assets()) {
    EXPECT_EQ(unpacked(asset.gzip), content(BIOTOMY_PAGE_DIST + std::string(asset.path)))
        << asset.path;
  }
}

TEST(PageAssets, AreAllThatWasBuilt) {
  std::size_t files = 1;  // index.html
  const std::filesystem::path folder = std::filesystem::path(BIOTOMY_PAGE_DIST) / "assets";
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    files += entry.is_regular_file() ? 1 : 0;
  }
  EXPECT_EQ(page_assets().size(), files);
}

TEST(PageAssets, CarryNoMomentSoThatABuildCanBeRepeated) {
  for (const PageAsset& asset : page_assets()) {
    ASSERT_GT(asset.gzip.size(), 10U);
    EXPECT_EQ(asset.gzip.substr(4, 4), std::string_view("\0\0\0\0", 4)) << asset.path;
  }
}

TEST(PageAssets, ThatThePageNamesAreThere) {
  std::set<std::string_view> paths;
  for (const PageAsset& asset : page_assets()) paths.insert(asset.path);
  const std::string html = the_page();
  std::size_t named = 0;
  for (const std::string mark : {"src=\"", "href=\""}) {
    for (std::size_t at = html.find(mark); at != std::string::npos; at = html.find(mark, at)) {
      at += mark.size();
      const std::string path = html.substr(at, html.find('"', at) - at);
      EXPECT_EQ(paths.count(path), 1U) << path;
      EXPECT_THAT(path, StartsWith("/assets/"));
      ++named;
    }
  }
  EXPECT_GE(named, 3U);  // the program, the styles, the icon
}

TEST(PageAssets, HaveNothingInThePageThatAStrictPolicyForbids) {
  const std::string html = the_page();
  EXPECT_THAT(html, Not(HasSubstr("<style")));
  EXPECT_THAT(html, Not(HasSubstr(" style=")));
  EXPECT_THAT(html, Not(HasSubstr("javascript:")));
  EXPECT_THAT(html, Not(HasSubstr(" on")));  // onload="…" and its like
  for (std::size_t at = html.find("<script"); at != std::string::npos;
       at = html.find("<script", at + 1)) {
    const std::size_t end = html.find('>', at);
    EXPECT_THAT(html.substr(at, end - at), HasSubstr(" src=\"/assets/"));
    EXPECT_EQ(html.compare(end, 10, "></script>"), 0);
  }
}

}  // namespace
}  // namespace biotomy::tests
