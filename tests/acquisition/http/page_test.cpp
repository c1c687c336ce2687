#include "acquisition/http/page.hpp"

#include <array>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <zlib.h>

namespace biotomy::tests {
namespace {

using namespace acquisition;
using testing::HasSubstr;

std::string gzip(const std::string& text) {
  z_stream stream{};
  deflateInit2(&stream, Z_BEST_COMPRESSION, Z_DEFLATED, 15 + 16, 8, Z_DEFAULT_STRATEGY);
  std::string packed(deflateBound(&stream, text.size()), '\0');
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(text.data()));
  stream.avail_in = static_cast<uInt>(text.size());
  stream.next_out = reinterpret_cast<Bytef*>(packed.data());
  stream.avail_out = static_cast<uInt>(packed.size());
  deflate(&stream, Z_FINISH);
  packed.resize(stream.total_out);
  deflateEnd(&stream);
  return packed;
}

struct PageTest : testing::Test {
  std::string html = "<!doctype html>" + std::string(50000, ' ') + "end";
  std::string packed_html = gzip(html);
  std::string packed_script = gzip("let a = 1;");
  std::array<PageAsset, 2> assets{
      PageAsset{"/index.html", "text/html; charset=utf-8", packed_html},
      PageAsset{"/assets/main-3f2a.js", "text/javascript", packed_script}};
  Page page{assets};

  ApiResponse get(const std::string& path, const std::string& accept_encoding = "gzip, br",
                  const std::string& if_none_match = "") const {
    ApiRequest request;
    request.method = "GET";
    request.path = path;
    request.accept_encoding = accept_encoding;
    request.if_none_match = if_none_match;
    return page.answer(request);
  }
};

TEST_F(PageTest, GivesTheFilesCompressedAsTheyAre) {
  const ApiResponse response = get("/");
  EXPECT_EQ(response.status, 200);
  EXPECT_EQ(response.body, packed_html);
  EXPECT_EQ(response.headers.at("Content-Encoding"), "gzip");
  EXPECT_EQ(response.content_type, "text/html; charset=utf-8");
}

TEST_F(PageTest, UnpacksThemForWhoTakesNoGzip) {
  const ApiResponse response = get("/index.html", "");
  EXPECT_EQ(response.body, html);
  EXPECT_EQ(response.headers.count("Content-Encoding"), 0U);
}

TEST_F(PageTest, LetsABrowserKeepWhatNeverChanges) {
  EXPECT_THAT(get("/assets/main-3f2a.js").headers.at("Cache-Control"), HasSubstr("immutable"));
  EXPECT_EQ(get("/").headers.at("Cache-Control"), "no-cache");
}

TEST_F(PageTest, SendsNothingThatTheBrowserHas) {
  const std::string tag = get("/").headers.at("ETag");
  const ApiResponse again = get("/", "gzip", "W/\"other\", " + tag);
  EXPECT_EQ(again.status, 304);
  EXPECT_TRUE(again.body.empty());
  EXPECT_EQ(get("/", "gzip", "\"other\"").status, 200);
}

TEST_F(PageTest, KnowsItsPathsAlone) {
  ApiRequest request;
  for (const char* path : {"/", "/index.html", "/assets/x"}) {
    request.path = path;
    EXPECT_TRUE(page.answers(request)) << path;
  }
  for (const char* path : {"/api/v1/status", "/asset", ""}) {
    request.path = path;
    EXPECT_FALSE(page.answers(request)) << path;
  }
  EXPECT_EQ(get("/assets/../index.html").status, 404);
  request.path = "/";
  request.method = "POST";
  EXPECT_EQ(page.answer(request).status, 405);
}

TEST(NoPage, SaysThatThereIsNone) {
  const Page page{std::span<const PageAsset>()};
  ApiRequest request;
  request.method = "GET";
  request.path = "/";
  const ApiResponse response = page.answer(request);
  EXPECT_EQ(response.status, 200);
  EXPECT_THAT(response.body, HasSubstr("built without its page"));
  // It must show under the policy that every answer has.
  EXPECT_THAT(response.body, testing::Not(HasSubstr("style")));
  EXPECT_THAT(response.body, testing::Not(HasSubstr("<script")));
}

}  // namespace
}  // namespace biotomy::tests
