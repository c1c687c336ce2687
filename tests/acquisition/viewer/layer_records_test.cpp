#include "acquisition/viewer/layer_records.hpp"

#include <filesystem>
#include <fstream>
#include <map>
#include <string>

#include <gmock/gmock.h>

#include "acquisition/records/layer_journal.hpp"
#include "tests/acquisition/viewer/part_content.hpp"
#include "tests/acquisition/viewer/viewed_sample.hpp"
#include "tests/file_content.hpp"

namespace biotomy::acquisition {
namespace {

using nlohmann::json;
using testing::HasSubstr;

constexpr const char* kAt = "2026-11-22T03:04:05.678Z";
const std::string kSha = std::string(60, '0') + "beef";

AttemptRow attempt(std::int64_t layer, int number, Verdict verdict, const std::string& file) {
  AttemptRow row;
  row.layer = layer;
  row.attempt = number;
  row.taken_at = kAt;
  row.exposure_us = 4000;
  row.gain = 1.5;
  row.column = {612.5};
  row.assessment.verdict = verdict;
  row.assessment.slug = verdict == Verdict::rejected ? "blurred" : "good";
  row.assessment.reason = "as it is";
  row.assessment.metrics = {{"sharpness_ratio", 0.5 + 0.1 * number, 0.7, number > 1},
                            {"brightness", 0.4, 0.3, true}};
  row.file = file;
  row.sha256 = kSha;
  return row;
}

/// A rig's sample: layer 1 at the first attempt, layer 2 at the third, layer 3 in work.
class LayerRecordsOfARig : public ViewedSample {
 protected:
  void SetUp() override {
    add_layers(1, 2);
    LayerJournal journal(sample_.journal_path());
    journal.commit_layer(attempt(1, 1, Verdict::accepted, "layers/000001.tif"), 77, kAt);
    journal.record_attempt(attempt(2, 1, Verdict::rejected, "rejected/000002-a01-blurred.jpg"));
    journal.record_attempt(attempt(2, 2, Verdict::rejected, "rejected/000002-a02-blurred.jpg"));
    journal.commit_layer(attempt(2, 3, Verdict::accepted_with_flag, "layers/000002.tif"), 78, kAt);
    journal.record_attempt(attempt(3, 1, Verdict::rejected, "rejected/000003-a01-blurred.jpg"));
    std::ofstream(sample_.rejected_path() / "000002-a02-blurred.jpg") << "a picture";
    std::ofstream(sample_.rejected_path() / "another.jpg") << "nobody's";
    std::filesystem::create_symlink("/etc/passwd",
                                    sample_.rejected_path() / "000003-a01-blurred.jpg");
  }
};

TEST_F(LayerRecordsOfARig, ListTheLayersAsTheJournalHasThem) {
  const json all = json_of(ask("/api/v1/layers"));
  EXPECT_EQ(all.at("count"), 2);
  ASSERT_EQ(all.at("layers").size(), 2U);
  EXPECT_EQ(all.at("layers").at(1).at("flagged"), true);
  EXPECT_EQ(all.at("layers").at(1).at("attempt"), 3);
  EXPECT_EQ(all.at("layers").at(1).at("sha256"), kSha);
  const json second = json_of(ask("/api/v1/layers", {{"from", "2"}, {"limit", "1"}}));
  EXPECT_EQ(second.at("layers").at(0).at("layer"), 2);
  EXPECT_EQ(ask("/api/v1/layers", {{"from", "0"}}).status, 400);
  EXPECT_EQ(sentence_of(ask("/api/v1/layers", {{"limit", "1001"}})),
            "limit must be a number from 1 to 1000");
}

TEST_F(LayerRecordsOfARig, TellAllAttemptsAtALayerAndWhereTheirPicturesAre) {
  const json layer = json_of(ask("/api/v1/layers/2"));
  EXPECT_EQ(layer.at("committed_at"), kAt);
  EXPECT_EQ(layer.at("flagged"), true);
  EXPECT_EQ(layer.at("bytes"), 78);
  EXPECT_EQ(layer.at("width"), 60);
  ASSERT_EQ(layer.at("attempts").size(), 3U);
  const json& first = layer.at("attempts").at(0);
  EXPECT_EQ(first.at("slug"), "blurred");
  EXPECT_EQ(first.at("column_um"), 612.5);
  EXPECT_EQ(first.at("exposure_us"), 4000);
  EXPECT_EQ(first.at("metrics").at(0).at("passed"), false);
  EXPECT_TRUE(first.at("image").is_null()) << "it is not kept any more";
  EXPECT_EQ(layer.at("attempts").at(1).at("image"), "/api/v1/rejected/000002-a02-blurred.jpg");
  EXPECT_EQ(layer.at("attempts").at(2).at("image"), "/api/v1/layers/2/image?v=00000000");
}

TEST_F(LayerRecordsOfARig, TellOfALayerThatIsInWorkAndNotOfOthers) {
  const json layer = json_of(ask("/api/v1/layers/3"));
  EXPECT_TRUE(layer.at("committed_at").is_null());
  EXPECT_EQ(layer.at("attempts").size(), 1U);
  EXPECT_EQ(ask("/api/v1/layers/4").status, 404);
  EXPECT_EQ(ask("/api/v1/layers/0").status, 404);
}

TEST_F(LayerRecordsOfARig, ListRejectedFramesTheNewestFirst) {
  const json all = json_of(ask("/api/v1/rejected"));
  EXPECT_EQ(all.at("count"), 3);
  ASSERT_EQ(all.at("rejected").size(), 3U);
  EXPECT_EQ(all.at("rejected").at(0).at("layer"), 3);
  EXPECT_EQ(all.at("rejected").at(2).at("attempt"), 1);
  const std::int64_t newest = all.at("rejected").at(0).at("id");
  const json before =
      json_of(ask("/api/v1/rejected", {{"before", std::to_string(newest)}, {"limit", "1"}}));
  ASSERT_EQ(before.at("rejected").size(), 1U);
  EXPECT_EQ(before.at("rejected").at(0).at("attempt"), 2);
}

TEST_F(LayerRecordsOfARig, GiveNoFileThatTheJournalDoesNotName) {
  const ApiResponse kept = ask("/api/v1/rejected/000002-a02-blurred.jpg");
  ASSERT_EQ(kept.status, 200) << kept.body;
  ASSERT_TRUE(kept.file);
  // A frame of another sample may have the same name.
  EXPECT_EQ(kept.headers.at("Cache-Control"), "no-cache");
  EXPECT_EQ(kept.file->bytes, 9U);
  EXPECT_EQ(tests::content_of(*kept.file),
            tests::content_of(sample_.rejected_path() / "000002-a02-blurred.jpg"));
  for (const char* name : {"another.jpg", "000002-a01-blurred.jpg", "../journal.sqlite", "..",
                           "000003-a01-blurred.jpg", "", "/etc/passwd"}) {
    const ApiResponse response = ask("/api/v1/rejected/" + std::string(name));
    EXPECT_FALSE(response.file) << name;
    EXPECT_EQ(response.status, 404) << name;
  }
}

TEST_F(LayerRecordsOfARig, GiveTheHistoryOfMetricsInColumns) {
  const json history =
      json_of(ask("/api/v1/history", {{"metrics", "sharpness_ratio,brightness,no_such"}}));
  EXPECT_EQ(history.at("layer"), json({1, 2, 2, 2, 3}));
  EXPECT_EQ(history.at("attempt"), json({1, 1, 2, 3, 1}));
  EXPECT_EQ(history.at("verdict").at(3), "accepted_with_flag");
  EXPECT_EQ(history.at("last"), history.at("id").back());
  EXPECT_EQ(history.at("metrics").at("sharpness_ratio").at("value"),
            json({0.6, 0.6, 0.7, 0.8, 0.6}));
  EXPECT_EQ(history.at("metrics").at("brightness").at("limit"), json({0.3, 0.3, 0.3, 0.3, 0.3}));
  EXPECT_TRUE(history.at("metrics").at("no_such").at("value").at(4).is_null());

  const std::string third = std::to_string(history.at("id").at(2).get<std::int64_t>());
  const json later = json_of(ask("/api/v1/history", {{"after", third}}));
  EXPECT_EQ(later.at("layer"), json({2, 3}));
  const json none =
      json_of(ask("/api/v1/history", {{"after", std::to_string(history.at("last").get<int>())}}));
  EXPECT_EQ(none.at("last"), history.at("last"));
  EXPECT_EQ(none.at("id").size(), 0U);
}

/// A sample of somebody's images.
using LayerRecordsOfAnImport = ViewedSample;

TEST_F(LayerRecordsOfAnImport, HaveLayersAndNoAttempts) {
  add_layers(1, 3);
  std::ofstream(sample_.hashes_path()) << kSha << "  layers/000002.tif\n";
  const json all = json_of(ask("/api/v1/layers"));
  EXPECT_EQ(all.at("count"), 3);
  ASSERT_EQ(all.at("layers").size(), 3U);
  EXPECT_EQ(all.at("layers").at(1).at("file"), "layers/000002.tif");
  EXPECT_EQ(all.at("layers").at(1).at("sha256"), kSha);
  EXPECT_TRUE(all.at("layers").at(1).at("committed_at").is_null());
  const json layer = json_of(ask("/api/v1/layers/2"));
  EXPECT_EQ(layer.at("attempts"), json::array());
  EXPECT_EQ(layer.at("image"), "/api/v1/layers/2/image?v=00000000");
  EXPECT_EQ(json_of(ask("/api/v1/rejected")), (json{{"count", 0}, {"rejected", json::array()}}));
  EXPECT_EQ(json_of(ask("/api/v1/history", {{"metrics", "brightness"}})).at("last"), 0);
  EXPECT_EQ(ask("/api/v1/rejected/a.jpg").status, 404);
}

TEST_F(LayerRecordsOfAnImport, AreEmptyAtTheBeginning) {
  EXPECT_EQ(json_of(ask("/api/v1/layers")).at("count"), 0);
  EXPECT_THAT(sentence_of(ask("/api/v1/layers/1")), HasSubstr("there is no layer 1 yet"));
  EXPECT_EQ(ask("/api/v1/layers/1/image").status, 404);
}

TEST(LayerRecords, AreEmptyBeforeThereIsASample) {
  const tests::TemporaryFolder folder;
  const SampleApi api(folder / "not yet", {});
  const auto asked = [&](const std::string& path) {
    return api.answer({.method = "GET", .path = "/api/v1/" + path});
  };
  EXPECT_EQ(json::parse(asked("layers").body), (json{{"count", 0}, {"layers", json::array()}}));
  EXPECT_EQ(json::parse(asked("rejected").body), (json{{"count", 0}, {"rejected", json::array()}}));
  EXPECT_EQ(json::parse(asked("exports").body), (json{{"exports", json::array()}}));
  EXPECT_EQ(json::parse(asked("history").body).at("id"), json::array());
  EXPECT_EQ(asked("layers/1").status, 404);
  EXPECT_EQ(asked("sample").status, 404);
}

TEST_F(LayerRecordsOfAnImport, SayThatAJournalCannotBeRead) {
  std::ofstream(sample_.journal_path()) << "this is no journal of ours";
  EXPECT_EQ(ask("/api/v1/layers").status, 503);
}

}  // namespace
}  // namespace biotomy::acquisition
