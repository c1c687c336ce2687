#include "acquisition/http/request_target.hpp"

#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace biotomy::tests {
namespace {

using namespace acquisition;
using testing::ElementsAre;
using testing::Pair;

TEST(RequestTarget, IsDecodedPathAndParameters) {
  const auto target = parse_target("/layers/a%20b+c?points=0,1+2%2C3&basis=xz&fit=&same");
  ASSERT_TRUE(target);
  EXPECT_EQ(target->path, "/layers/a b+c");
  EXPECT_THAT(target->query, ElementsAre(Pair("basis", "xz"), Pair("fit", ""),
                                         Pair("points", "0,1 2,3"), Pair("same", "")));
}

TEST(RequestTarget, TakesTheLastOfTwoParametersOfOneName) {
  EXPECT_THAT(parse_target("/?a=1&a=2&&")->query, ElementsAre(Pair("a", "2")));
}

TEST(RequestTarget, LeavesOutWhatOnlyABrowserMeans) {
  EXPECT_EQ(parse_target("/a#/run?b=c")->path, "/a");
}

TEST(RequestTarget, RefusesWhatIsNoPath) {
  for (const char* text : {"", "a", "*", "http://rig/", "?a=b", "/%", "/%4", "/%4g", "/%g4", "/%-1",
                           "/?a=%", "/?%=a"}) {
    EXPECT_FALSE(parse_target(text)) << text;
  }
}

TEST(RequestTarget, RefusesPathsThatLeadUp) {
  for (const char* text : {"/..", "/a/../b", "/%2e%2e/a", "/a/..%2fb", "/./a", "/a%5c..%5cb",
                           "/a%00b", "/a%0d%0ab", "/a/.."}) {
    EXPECT_FALSE(parse_target(text)) << text;
  }
  EXPECT_TRUE(parse_target("/a..b/...c/.zarray"));
}

TEST(RequestTarget, BoundsTheNumberOfParameters) {
  std::string text = "/?";
  for (int i = 0; i < 64; ++i) text += "p" + std::to_string(i) + "=1&";
  EXPECT_TRUE(parse_target(text));
  EXPECT_FALSE(parse_target(text + "one=more"));
}

}  // namespace
}  // namespace biotomy::tests
