#include <chrono>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "acquisition/viewer/sample_api.hpp"
#include "tests/acquisition/viewer/exports/archive_content.hpp"
#include "tests/faults/small_sample.hpp"
#include "tests/file_content.hpp"
#include "tests/integration/child_process.hpp"
#include "tests/temporary_folder.hpp"

namespace biotomy::tests {
namespace {

namespace fs = std::filesystem;

using nlohmann::json;
using Query = std::map<std::string, std::string>;

/// The commands that the page offers to copy, run by a shell as a person would.
class CommandsOfThePage : public testing::Test {
 protected:
  void SetUp() override {
    write_small_images(folder_ / "images");
    const Outcome imported = run(import_command(folder_ / "images", sample_), folder_.path());
    ASSERT_EQ(imported.exit_code, 0) << imported.errors;
    api_ = std::make_unique<acquisition::SampleApi>(sample_, acquisition::ViewerSettings{});
  }

  acquisition::ApiResponse ask(const std::string& path, const Query& query) const {
    return api_->answer({.method = "GET", .path = "/api/v1/" + path, .query = query});
  }

  void run_in_shell(const std::string& command) const {
    const fs::path tools = fs::path(BIOTOMY_TOOL).parent_path();
    const Outcome outcome = run(
        {"/bin/sh", "-c",
         "PATH='" + tools.string() + "':$PATH; cd '" + folder_.path().string() + "' && " + command},
        folder_.path());
    ASSERT_EQ(outcome.exit_code, 0) << command << "\n" << outcome.errors;
  }

  TemporaryFolder folder_;
  const fs::path sample_ = folder_ / "Ann's knee $1 042";
  std::unique_ptr<acquisition::SampleApi> api_;
};

TEST_F(CommandsOfThePage, MakeTheVeryFileThatIsShown) {
  const Query plane{{"points", "0,0,0 390,0,0 0,290,80"}};
  const std::vector<Query> queries = {
      plane,
      {{"normal", "-1,2,-3"}, {"through", "0.195,0.145,0.04"}, {"unit", "mm"}, {"pixel", "0.0071"}},
      {{"normal", "0,0,1"}, {"through", "0,0,2"}, {"unit", "voxel"}, {"fit", "17x500"}},
      {{"normal", "1,1,1"},
       {"through", "195,145,40"},
       {"basis", "xz"},
       {"theta", "inscribed"},
       {"interpolation", "cubic"},
       {"background", "1,2,3"}},
      {{"normal", "1,1,1"}, {"through", "195,145,40"}, {"theta", "custom:195,145,40,50,30,-12.5"}}};
  for (const Query& asked : queries) {
    for (const auto& [format, extension] :
         std::map<std::string, std::string>{{"png", "png"}, {"jpeg", "jpg"}, {"tiff", "tif"}}) {
      Query query = asked;
      query["format"] = format;
      if (format == "jpeg") query["quality"] = "75";
      const acquisition::ApiResponse shown = ask("section", query);
      ASSERT_EQ(shown.status, 200) << shown.body;
      const json record = json::parse(shown.headers.at("Biotomy-Section"));
      run_in_shell(record.at("command_here"));
      const fs::path file = folder_ / ("section." + extension);
      EXPECT_TRUE(content_of(file) == shown.body) << record.at("command_here");
      fs::remove(file);
    }
  }
}

TEST_F(CommandsOfThePage, MakeTheFullResolutionOfWhatWasMadeToFit) {
  const Query full{{"points", "0,0,0 390,0,0 0,290,80"}};
  Query small = full;
  small["fit"] = "20x20";
  const json record = json::parse(ask("section", small).headers.at("Biotomy-Section"));
  run_in_shell(record.at("command"));
  EXPECT_TRUE(content_of(folder_ / "section.png") == ask("section", full).body);
}

TEST_F(CommandsOfThePage, MakeTheSeriesThatIsPlayed) {
  for (const Query& series :
       {Query{{"kind", "rotate"}, {"axis", "-1,0.5,0"}, {"step", "45"}, {"theta", "inscribed-any"}},
        Query{{"kind", "translate"}, {"normal", "0,0,-1"}, {"step", "40"}, {"format", "jpeg"}}}) {
    Query query = series;
    query["index"] = "0";
    const acquisition::ApiResponse frame = ask("series/frame", query);
    ASSERT_EQ(frame.status, 200) << frame.body;
    const json record = json::parse(frame.headers.at("Biotomy-Section"));
    run_in_shell(record.at("command"));
    const json frames = json::parse(ask("series/frames", series).body).at("frames");
    std::size_t pictures = 0;
    for (const auto& entry : fs::directory_iterator(folder_ / "series")) {
      pictures += entry.path().extension() == ".json" ? 0 : 1;
    }
    EXPECT_EQ(pictures, frames.size());
    fs::remove_all(folder_ / "series");
  }
}

TEST_F(CommandsOfThePage, MakeTheFramesThatAreExported) {
  const acquisition::ApiResponse ordered =
      api_->answer({.method = "POST",
                    .path = "/api/v1/exports",
                    .body = R"({"kind":"series","series":{"kind":"rotate","axis":"y","step":60},)"
                            R"("parameters":{"theta":"inscribed"}})"});
  ASSERT_EQ(ordered.status, 202) << ordered.body;
  const std::string id = json::parse(ordered.body).at("id");
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(60);
  while (ask("exports/" + id, {}).body.find(R"("state":"done")") == std::string::npos) {
    ASSERT_LT(std::chrono::steady_clock::now(), deadline) << ask("exports/" + id, {}).body;
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  run_in_shell(json::parse(ordered.body).at("command"));
  const fs::path exports = acquisition::default_exports_folder(sample_);
  const auto frames = acquisition::archive_content(exports / id / "series.zip");
  EXPECT_EQ(frames.size(), 4U);
  for (const auto& [name, content] : frames) {
    EXPECT_TRUE(content_of(folder_ / "series" / name) == content) << name;
  }
}

}  // namespace
}  // namespace biotomy::tests
