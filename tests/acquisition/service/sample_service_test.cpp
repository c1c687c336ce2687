#include "acquisition/service/sample_service.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/temporary_folder.hpp"

namespace biotomy::tests {
namespace {

using namespace acquisition;

struct SampleServiceTest : testing::Test {
  TemporaryFolder folder;
  Page page{std::span<const PageAsset>()};
  SampleApi sample{folder.path() / "knee", {}};
  EventFeed feed;
  SampleService service{{.kind = ServiceDescription::Kind::view,
                         .reading_needs_token = false,
                         .commands_need_token = false,
                         .sample = "knee",
                         .neuroglancer = "https://neuroglancer.example"},
                        page,
                        sample,
                        feed};

  ApiResponse ask(const std::string& path, const std::string& method = "GET") const {
    ApiRequest request;
    request.method = method;
    request.path = path;
    return service.answer(request);
  }
};

TEST_F(SampleServiceTest, SaysThatThereIsNoRig) {
  const auto description = nlohmann::json::parse(ask("/api/v1/service").body);
  EXPECT_EQ(description.at("kind"), "view");
  EXPECT_EQ(description.at("reading"), "open");
  EXPECT_FALSE(description.at("commands_need_token"));
  EXPECT_EQ(description.at("neuroglancer"), "https://neuroglancer.example");
  EXPECT_EQ(ask("/api/v1/status").status, 404);
  EXPECT_EQ(ask("/api/v1/control/start", "POST").status, 404);
  EXPECT_EQ(ask("/metrics").status, 404);
}

TEST_F(SampleServiceTest, ServesPageEventsAndHealth) {
  EXPECT_EQ(ask("/").status, 200);
  EXPECT_EQ(ask("/healthz").status, 200);
  EXPECT_EQ(ask("/healthz", "POST").status, 405);
  feed.tell_state("sample", "sample", "{}");
  const ApiResponse response = ask("/api/v1/events");
  ASSERT_TRUE(response.events);
  EXPECT_EQ(response.events->take().size(), 1U);
}

TEST_F(SampleServiceTest, HandsOnWhatIsTheSamples) {
  ApiRequest request;
  request.method = "GET";
  request.path = "/api/v1/sample";
  EXPECT_EQ(ask(request.path).status, sample.answer(request).status);
}

TEST_F(SampleServiceTest, LeavesWhateverIsDrawnToThePicturesLane) {
  const auto lane = [&](const std::string& path) {
    ApiRequest request;
    request.path = path;
    return service.lane(request);
  };
  for (const char* drawn : {"/api/v1/section", "/api/v1/series/frame", "/api/v1/layers/1/image",
                            "/api/v1/layers/1/tiles/0/0/0", "/api/v1/layers/1/sharpness"}) {
    EXPECT_EQ(lane(drawn), Lane::pictures) << drawn;
  }
  for (const char* sent : {"/api/v1/rejected/a.jpg", "/api/v1/exports/1/files/section.png",
                           "/volume.ome.zarr/zarr.json"}) {
    EXPECT_EQ(lane(sent), Lane::files) << sent;
  }
  for (const char* looked_at :
       {"/api/v1/service", "/api/v1/section/outline", "/api/v1/series/frames", "/api/v1/layers/1",
        "/api/v1/rejected", "/api/v1/exports", "/api/v1/sample", "/"}) {
    EXPECT_EQ(lane(looked_at), Lane::quick) << looked_at;
  }
}

}  // namespace
}  // namespace biotomy::tests
