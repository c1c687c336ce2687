#include "acquisition/http/request_guard.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "acquisition/http/own_host_names.hpp"

namespace biotomy::tests {
namespace {

using namespace acquisition;
using testing::HasSubstr;
using testing::Optional;

constexpr const char* kNeuroglancer = "https://neuroglancer-demo.appspot.com";

ApiRequest asked(const std::string& path, const std::string& host = "127.0.0.1:8080") {
  ApiRequest request;
  request.method = "GET";
  request.path = path;
  request.host = host;
  return request;
}

struct RequestGuardTest : testing::Test {
  RequestGuard guard{{.hosts = {"Rig.Lab"}, .neuroglancer_origin = kNeuroglancer}};

  /// The status that it is refused with, 0 when it is let in.
  int refusal(const ApiRequest& request) const {
    const auto answer = guard.answer(request);
    return answer ? answer->status : 0;
  }

  std::map<std::string, std::string> marks(const ApiRequest& request) const {
    ApiResponse response;
    guard.mark(request, response);
    return response.headers;
  }
};

TEST_F(RequestGuardTest, KnowsItsOwnNamesAndAddresses) {
  for (const char* host : {"127.0.0.1:8080", "127.0.0.1", "[::1]:8080", "192.168.7.20:80",
                           "localhost", "LOCALHOST:8080", "rig.lab", "rig.lab.:8080"}) {
    EXPECT_EQ(refusal(asked("/", host)), 0) << host;
  }
  ASSERT_FALSE(own_host_names().empty());
  for (const std::string& name : own_host_names()) {
    EXPECT_EQ(refusal(asked("/", name + ":8080")), 0) << name;
  }
}

TEST_F(RequestGuardTest, AnswersUnderNoOtherName) {
  for (const char* host : {"", "evil.example", "evil.example:8080", "127.0.0.1.evil.example",
                           "rig.lab.evil.example", "localhost.evil.example", "rig.lab:x",
                           "rig.lab:123456", "[::1", "[::1]x", ":8080", "rig.lab/evil"}) {
    EXPECT_EQ(refusal(asked("/healthz", host)), 421) << host;
  }
}

TEST_F(RequestGuardTest, LetsOnlyItsOwnPageAsk) {
  ApiRequest request = asked("/api/v1/control/abort", "rig.lab:8080");
  request.method = "POST";
  for (const char* own :
       {"", "http://rig.lab:8080", "https://rig.lab:8080", "HTTP://RIG.LAB:8080"}) {
    request.origin = own;
    EXPECT_EQ(refusal(request), 0) << own;
  }
  for (const char* foreign : {"http://evil.example", "http://rig.lab", "http://rig.lab:8081",
                              "http://127.0.0.1:8080", "null", kNeuroglancer}) {
    request.origin = foreign;
    EXPECT_EQ(refusal(request), 403) << foreign;
  }
  request.origin = "null";
  request.sec_fetch_site = "same-origin";
  EXPECT_EQ(refusal(request), 0);
}

TEST_F(RequestGuardTest, LetsNoOtherSiteFetchButFollowALink) {
  ApiRequest request = asked("/api/v1/layers/1/image");
  for (const char* site : {"cross-site", "same-site"}) {
    request.sec_fetch_site = site;
    request.sec_fetch_mode = "no-cors";
    EXPECT_EQ(refusal(request), 403) << site;
    request.sec_fetch_mode = "navigate";
    EXPECT_EQ(refusal(request), 403) << site;
    ApiRequest link = request;
    link.path = "/";
    EXPECT_EQ(refusal(link), 0) << site;
    link.method = "POST";
    EXPECT_EQ(refusal(link), 403) << site;
  }
  request.sec_fetch_site = "none";
  EXPECT_EQ(refusal(request), 0);
}

TEST_F(RequestGuardTest, LetsNeuroglancerReadTheVolumeAlone) {
  ApiRequest request = asked("/volume.ome.zarr/zarr.json");
  request.origin = kNeuroglancer;
  request.sec_fetch_site = "cross-site";
  EXPECT_EQ(refusal(request), 0);
  EXPECT_EQ(marks(request).at("Access-Control-Allow-Origin"), kNeuroglancer);
  EXPECT_EQ(marks(request).count("Cross-Origin-Resource-Policy"), 0U);

  request.method = "POST";
  EXPECT_EQ(refusal(request), 403);
  request.method = "GET";
  for (const char* path : {"/api/v1/status", "/volume.ome.zarrx", "/"}) {
    request.path = path;
    EXPECT_EQ(refusal(request), 403) << path;
    EXPECT_EQ(marks(request).count("Access-Control-Allow-Origin"), 0U) << path;
  }
  request.path = "/volume.ome.zarr/zarr.json";
  request.origin = "https://evil.example";
  EXPECT_EQ(refusal(request), 403);
  EXPECT_EQ(marks(request).count("Access-Control-Allow-Origin"), 0U);
  EXPECT_EQ(marks(request).at("Vary"), "Origin");
}

TEST_F(RequestGuardTest, AnswersABrowserThatAsksForNeuroglancer) {
  ApiRequest request = asked("/volume.ome.zarr/0/c/0/0/0/0");
  request.method = "OPTIONS";
  request.origin = kNeuroglancer;
  request.sec_fetch_site = "cross-site";
  request.asks_private_network = true;
  EXPECT_EQ(refusal(request), 204);
  const auto headers = marks(request);
  EXPECT_THAT(headers.at("Access-Control-Allow-Methods"), HasSubstr("GET"));
  EXPECT_THAT(headers.at("Access-Control-Allow-Headers"), HasSubstr("Range"));
  EXPECT_EQ(headers.at("Access-Control-Allow-Private-Network"), "true");
}

TEST_F(RequestGuardTest, LetsNoForeignPageInWhenNoneIsNamed) {
  const RequestGuard closed({.hosts = {}, .neuroglancer_origin = ""});
  ApiRequest request = asked("/volume.ome.zarr/zarr.json");
  request.origin = kNeuroglancer;
  ASSERT_TRUE(closed.answer(request));
  EXPECT_EQ(closed.answer(request)->status, 403);
}

TEST_F(RequestGuardTest, MarksEveryAnswer) {
  const auto headers = marks(asked("/"));
  EXPECT_THAT(headers.at("Content-Security-Policy"), HasSubstr("script-src 'self'"));
  EXPECT_THAT(headers.at("Content-Security-Policy"), testing::Not(HasSubstr("unsafe")));
  EXPECT_EQ(headers.at("X-Content-Type-Options"), "nosniff");
  EXPECT_EQ(headers.at("Referrer-Policy"), "no-referrer");
  EXPECT_EQ(headers.at("Cross-Origin-Opener-Policy"), "same-origin");
  EXPECT_EQ(headers.at("Cross-Origin-Resource-Policy"), "same-origin");
  EXPECT_EQ(headers.at("Cache-Control"), "no-store");

  ApiResponse cached;
  cached.headers["Cache-Control"] = "no-cache";
  guard.mark(asked("/"), cached);
  EXPECT_EQ(cached.headers.at("Cache-Control"), "no-cache");
}

TEST(HostName, IsWithoutPortAndFinalDot) {
  EXPECT_THAT(host_name("Rig.Lab.:80"), Optional(std::string("rig.lab")));
  EXPECT_THAT(host_name("[FE80::1]:80"), Optional(std::string("fe80::1")));
  EXPECT_FALSE(host_name(""));
  EXPECT_FALSE(host_name("."));
  EXPECT_FALSE(host_name("a:b"));
}

}  // namespace
}  // namespace biotomy::tests
