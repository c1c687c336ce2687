#include "acquisition/viewer/exports/export_queue.hpp"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <filesystem>
#include <fstream>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include <gmock/gmock.h>

#include "reconstruct/picture/png_reader.hpp"
#include "tests/acquisition/viewer/exports/archive_content.hpp"
#include "tests/acquisition/viewer/part_content.hpp"
#include "tests/acquisition/viewer/viewed_sample.hpp"
#include "tests/file_content.hpp"

namespace biotomy::acquisition {
namespace {

namespace fs = std::filesystem;

using nlohmann::json;
using testing::HasSubstr;
using tests::content_of;

constexpr const char* kExports = "/api/v1/exports";
constexpr const char* kSection =
    R"({"kind":"section","format":"png","parameters":{"points":"0,0,0 590,0,0 0,539,780"}})";
constexpr const char* kTurn =
    R"({"kind":"series","format":"png","series":{"kind":"rotate","axis":"x","step":"60"},"movie":true})";
/// So many frames that it is never done before it is cancelled.
constexpr const char* kEndless =
    R"({"kind":"series","series":{"kind":"rotate","axis":"x","to":"180","step":"0.02"},"parameters":{"pixel":"2"}})";

class ExportsOfASample : public ViewedSample {
 protected:
  ExportsOfASample() {
    add_layers(1, 40);
    make_volume(40);
    begin();
  }
  ~ExportsOfASample() override { api_.reset(); }

  void begin() {
    api_ = std::make_unique<SampleApi>(
        sample_.path(), ViewerSettings{.cache_bytes = 50'000'000,
                                       .bytes_to_spare = [this] { return spare_.load(); }});
    api_->on_export([this](std::string text) {
      const std::lock_guard lock(mutex_);
      const json told = json::parse(text);
      told_[told.at("id")].push_back(told);
      changed_.notify_all();
    });
  }

  ApiResponse ask(const std::string& method, const std::string& path,
                  const std::string& body = {}) {
    return api_->answer({.method = method, .path = kExports + path, .body = body});
  }

  std::string order(const std::string& body) {
    const ApiResponse response = ask("POST", "", body);
    EXPECT_EQ(response.status, 202) << response.body;
    EXPECT_EQ(response.headers.at("Location"),
              kExports + ("/" + json_of(response).at("id").get<std::string>()));
    return json_of(response).at("id");
  }

  /// Waits until what was told of an export is as wanted; gives it.
  json wait(const std::string& id, const std::function<bool(const json&)>& wanted) {
    std::unique_lock lock(mutex_);
    json last;
    changed_.wait_for(lock, std::chrono::seconds(100), [&] {
      for (const json& told : told_[id]) {
        if (wanted(told)) {
          last = told;
          return true;
        }
      }
      return false;
    });
    return last;
  }

  json end_of(const std::string& id) {
    return wait(id, [](const json& told) {
      return told.at("state") != "queued" && told.at("state") != "running";
    });
  }

  std::vector<std::string> names_in_folder() const {
    std::vector<std::string> names;
    for (const auto& entry : fs::directory_iterator(exports_)) {
      names.push_back(entry.path().filename());
    }
    std::sort(names.begin(), names.end());
    return names;
  }

  const fs::path exports_ = folder_ / "knee 042-exports";
  std::atomic<std::uint64_t> spare_{100'000'000'000};
  std::mutex mutex_;
  std::condition_variable changed_;
  std::map<std::string, std::vector<json>> told_;
  std::unique_ptr<SampleApi> api_;
};

TEST_F(ExportsOfASample, GiveAFileOfASection) {
  const std::string id = order(kSection);
  const json end = end_of(id);
  ASSERT_EQ(end.at("state"), "done") << end.dump(1);
  EXPECT_EQ(end.at("unit"), "rows");
  EXPECT_EQ(end.at("done"), end.at("total"));
  ASSERT_EQ(end.at("files").size(), 1U);
  const json& file = end.at("files").at(0);
  EXPECT_EQ(file.at("url"), kExports + ("/" + id + "/files/section.png"));
  const ApiResponse download = ask("GET", "/" + id + "/files/section.png");
  ASSERT_EQ(download.status, 200);
  ASSERT_TRUE(download.file);
  EXPECT_EQ(download.file->bytes, file.at("bytes"));
  EXPECT_EQ(download.headers.at("Content-Disposition"),
            "attachment; filename=\"test-section.png\"");
  const std::string bytes = content_of(*download.file);
  const ApiResponse picture = api_->answer({.method = "GET",
                                            .path = "/api/v1/section",
                                            .query = {{"points", "0,0,0 590,0,0 0,539,780"}}});
  EXPECT_EQ(bytes, picture.body) << "the same picture as the one that is shown";
}

TEST_F(ExportsOfASample, GiveFramesAndAFilmOfASeries) {
  const std::string id = order(kTurn);
  const json end = end_of(id);
  ASSERT_EQ(end.at("state"), "done") << end.dump(1);
  EXPECT_EQ(end.at("unit"), "frames");
  EXPECT_EQ(end.at("total"), 4);
  ASSERT_EQ(end.at("files").size(), 2U);
  const auto frames = archive_content(exports_ / id / "series.zip");
  ASSERT_EQ(frames.size(), 4U);
  EXPECT_EQ(frames[1].first, "001_+060.0deg.png");
  const cv::Mat frame = reconstruct::decode_png(std::as_bytes(std::span(frames[1].second)));
  EXPECT_FALSE(frame.empty());
  EXPECT_GT(fs::file_size(exports_ / id / "series.mp4"), 0U);
  EXPECT_THAT(end.at("command").get<std::string>(), HasSubstr("--movie=series.mp4"));
}

TEST_F(ExportsOfASample, AreCancelledWhileTheyAreMadeAndLeaveNothing) {
  const std::string id = order(kEndless);
  ASSERT_FALSE(wait(id, [](const json& told) { return told.at("done") > 0; }).is_null());
  EXPECT_EQ(ask("DELETE", "/" + id).status, 200);
  EXPECT_EQ(end_of(id).at("state"), "cancelled");
  EXPECT_EQ(names_in_folder(), std::vector<std::string>{});
  EXPECT_EQ(ask("DELETE", "/" + id).status, 200) << "an ended one is removed";
  EXPECT_EQ(ask("GET", "/" + id).status, 404);
}

TEST_F(ExportsOfASample, WaitForEachOtherUpToANumber) {
  const std::string first = order(kEndless);
  ASSERT_FALSE(
      wait(first, [](const json& told) { return told.at("state") == "running"; }).is_null());
  std::vector<std::string> waiting;
  for (int i = 0; i < 8; ++i) waiting.push_back(order(kSection));
  const ApiResponse refused = ask("POST", "", kSection);
  EXPECT_EQ(refused.status, 429);
  EXPECT_THAT(sentence_of(refused), HasSubstr("8 exports wait already"));
  EXPECT_EQ(refused.headers.at("Retry-After"), "10");
  EXPECT_EQ(json_of(ask("GET", "")).at("exports").size(), 9U);
  EXPECT_EQ(json_of(ask("GET", "")).at("exports").at(8).at("id"), first) << "the newest first";
  ask("DELETE", "/" + waiting[0]);
  EXPECT_EQ(end_of(waiting[0]).at("state"), "cancelled");
  ask("DELETE", "/" + first);
  EXPECT_EQ(end_of(waiting[7]).at("state"), "done");
}

TEST_F(ExportsOfASample, AreRefusedWhenTheDiskHasNoRoomToSpare) {
  spare_ = 1000;
  const ApiResponse refused = ask("POST", "", kSection);
  EXPECT_EQ(refused.status, 507);
  EXPECT_THAT(sentence_of(refused), HasSubstr("to spare"));
  EXPECT_FALSE(fs::exists(exports_));
}

TEST_F(ExportsOfASample, EndWhenTheDiskHasNoMoreRoomToSpare) {
  const std::string id = order(kEndless);
  ASSERT_FALSE(wait(id, [](const json& told) { return told.at("done") > 0; }).is_null());
  spare_ = 0;
  const json end = end_of(id);
  EXPECT_EQ(end.at("state"), "failed");
  EXPECT_THAT(end.at("sentence").get<std::string>(), HasSubstr("no more room"));
  EXPECT_EQ(names_in_folder(), std::vector<std::string>{});
}

TEST_F(ExportsOfASample, AreFoundAgainAndLeftoversAreNot) {
  const std::string id = order(kSection);
  ASSERT_EQ(end_of(id).at("state"), "done");
  const json before = json_of(ask("GET", "/" + id));
  api_.reset();
  fs::create_directory(exports_ / ".unfinished-20260101-0000");
  std::ofstream(exports_ / ".unfinished-20260101-0000/section.png") << "half";
  fs::create_directory(exports_ / "somebody-elses");
  std::ofstream(exports_ / "notes.txt") << "mine";
  begin();
  EXPECT_EQ(json_of(ask("GET", "/" + id)), before);
  EXPECT_EQ(json_of(ask("GET", "")).at("exports").size(), 1U);
  EXPECT_EQ(names_in_folder(), (std::vector<std::string>{id, "notes.txt", "somebody-elses"}));
  EXPECT_EQ(ask("DELETE", "/" + id).status, 200);
  EXPECT_EQ(names_in_folder(), (std::vector<std::string>{"notes.txt", "somebody-elses"}));
}

TEST_F(ExportsOfASample, KeepTheLastTwenty) {
  std::vector<std::string> ids;
  for (int i = 0; i < 22; ++i) {
    ids.push_back(order(kSection));
    ASSERT_EQ(end_of(ids.back()).at("state"), "done");
  }
  // The last one's end is told before the oldest go.
  order(kEndless);
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(60);
  while (fs::exists(exports_ / ids[1]) && std::chrono::steady_clock::now() < deadline) {
    std::this_thread::yield();
  }
  EXPECT_FALSE(fs::exists(exports_ / ids[0]));
  EXPECT_FALSE(fs::exists(exports_ / ids[1]));
  EXPECT_TRUE(fs::exists(exports_ / ids[2]));
}

TEST_F(ExportsOfASample, KeepNoMoreOfThoseThatWereCancelledBeforeTheyBegan) {
  const std::string first = order(kEndless);
  ASSERT_FALSE(
      wait(first, [](const json& told) { return told.at("state") == "running"; }).is_null());
  for (int i = 0; i < 30; ++i) ask("DELETE", "/" + order(kSection));
  EXPECT_EQ(json_of(ask("GET", "")).at("exports").size(), 21U);
  ask("DELETE", "/" + first);
}

TEST_F(ExportsOfASample, SayWhatCannotBe) {
  EXPECT_EQ(ask("POST", "", "{").status, 400);
  EXPECT_EQ(ask("POST", "", R"({"kind":"section"})").status, 400);
  EXPECT_EQ(
      ask("POST", "", R"({"kind":"section","parameters":{"normal":"0,0,1","through":"0,0,9000"}})")
          .status,
      422);
  EXPECT_EQ(
      ask("POST", "",
          R"({"kind":"section","parameters":{"normal":"0,0,1","through":"0,0,0","pixel":"0.01"}})")
          .status,
      422);
  EXPECT_EQ(ask("GET", "/20260101-0000").status, 404);
  EXPECT_EQ(ask("DELETE", "/..").status, 404);
  EXPECT_EQ(ask("PUT", "").status, 405);
  EXPECT_EQ(ask("PUT", "").headers.at("Allow"), "GET, POST");
  EXPECT_EQ(ask("POST", "/x").headers.at("Allow"), "GET, DELETE");
  const std::string id = order(kSection);
  ASSERT_EQ(end_of(id).at("state"), "done");
  for (const char* name : {"export.json", "..", "../../sample.toml", "series.zip"}) {
    EXPECT_EQ(ask("GET", "/" + id + "/files/" + name).status, 404) << name;
  }
}

}  // namespace
}  // namespace biotomy::acquisition
